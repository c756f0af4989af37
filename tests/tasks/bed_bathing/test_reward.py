"""Each reward term of a hand-made step, by Assistive Gym's weights."""

import numpy as np
import pytest

from rigid.tasks.bed_bathing.parameters import RewardWeights
from rigid.tasks.bed_bathing.reward import reward_terms
from rigid.tasks.bed_bathing.sensing import Contacts
from rigid.tasks.physics.reward import HIGH_FORCE


def contacts(pad=0.0, elsewhere=0.0):
    """Two physics steps; the contact is at the second."""
    at = np.array([[0.0, pad]])
    rest = np.array([[0.0, elsewhere]])
    none = np.zeros((1, 2, 2, 2), dtype=bool)
    unwanted = np.array([elsewhere > 0])
    return Contacts(at + rest, at, rest, unwanted, np.zeros(1), none, np.zeros((1, 2, 2, 2, 3)))


def terms(**changes):
    given = {
        "distance": np.zeros(1),
        "wiped": np.zeros(1, dtype=np.int64),
        "action": np.zeros((1, 17)),
        "end_effector_speed": np.zeros(1),
        "contacts": contacts(),
    }
    return {
        name: float(v[0]) for name, v in reward_terms(RewardWeights(), **given | changes).items()
    }


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        pytest.param({"distance": np.array([0.3])}, {"distance": -0.3}, id="distance"),
        pytest.param({"wiped": np.array([4])}, {"wipe": 20.0}, id="wiped"),
        pytest.param({"action": np.full((1, 17), 1.0)}, {"action": -0.01 * 17**0.5}, id="action"),
        pytest.param({"end_effector_speed": np.array([0.4])}, {"velocity": -0.1}, id="velocity"),
        pytest.param({"contacts": contacts(pad=8.0)}, {}, id="gentle-pad"),
        pytest.param({"contacts": contacts(pad=HIGH_FORCE)}, {"high_force": -0.5}, id="hard-pad"),
        pytest.param({"contacts": contacts(elsewhere=20.0)}, {"other_force": -0.1}, id="arm"),
    ],
)
def test_a_term_pays_what_the_original_pays(changes, expected):
    found = terms(**changes)
    assert found == pytest.approx(dict.fromkeys(found, 0.0) | expected)


def test_every_weight_has_its_term():
    assert set(terms()) == set(RewardWeights.__dataclass_fields__)
