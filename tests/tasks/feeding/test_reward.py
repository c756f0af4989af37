"""Each reward term of a hand-made step, by Assistive Gym's weights."""

import numpy as np
import pytest

from rigid.tasks.feeding.parameters import RewardWeights
from rigid.tasks.feeding.reward import FoodEvents, reward_terms
from rigid.tasks.feeding.sensing import Contacts
from rigid.tasks.physics.reward import HIGH_FORCE


def contacts(spoon=0.0, arm=0.0):
    """Two physics steps; the contact is at the second."""
    at = np.array([[0.0, spoon]])
    whole = np.array([[0.0, spoon + arm]])
    return Contacts(whole, at, at, whole - at, np.array([arm > 0]))


def terms(**changes):
    given = {
        "distance": np.zeros(1),
        "food": FoodEvents(*np.zeros((3, 1), dtype=np.int64)),
        "action": np.zeros((1, 11)),
        "end_effector_speed": np.zeros(1),
        "spoon_speed": np.zeros(1),
        "contacts": contacts(),
    }
    return {
        name: float(v[0]) for name, v in reward_terms(RewardWeights(), **given | changes).items()
    }


def happened(eaten=0, spilled=0, on_person=0):
    return FoodEvents(*(np.array([count]) for count in (eaten, spilled, on_person)))


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        pytest.param({"distance": np.array([0.3])}, {"distance": -0.3}, id="distance"),
        pytest.param(
            {"food": happened(eaten=2), "spoon_speed": np.array([0.1])},
            {"food": 40.0, "food_speed": -0.2},
            id="eaten",
        ),
        pytest.param({"spoon_speed": np.array([0.1])}, {}, id="speed-without-food"),
        pytest.param(
            {"food": happened(spilled=3, on_person=2)},
            {"spill": -15.0, "food_hit": -2.0},
            id="spilled",
        ),
        pytest.param({"action": np.full((1, 11), 1.0)}, {"action": -0.01 * 11**0.5}, id="action"),
        pytest.param({"end_effector_speed": np.array([0.4])}, {"velocity": -0.1}, id="velocity"),
        pytest.param({"contacts": contacts(spoon=8.0)}, {"force": -0.04}, id="gentle-spoon"),
        pytest.param(
            {"contacts": contacts(spoon=HIGH_FORCE)},
            {"force": -0.05, "high_force": -0.5},
            id="hard-spoon",
        ),
        pytest.param({"contacts": contacts(arm=20.0)}, {"force": -0.1}, id="arm"),
    ],
)
def test_a_term_of_one_cause(changes, expected):
    found = terms(**changes)
    assert found == pytest.approx(dict.fromkeys(found, 0.0) | expected)


def test_every_weight_has_its_term():
    assert set(terms()) == set(RewardWeights.__dataclass_fields__)
