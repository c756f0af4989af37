"""The reward, term by term, and what makes a contact count."""

import numpy as np
import pytest

from rigid.tasks.itch_scratching.parameters import RewardWeights
from rigid.tasks.itch_scratching.reward import MOVED, counted_contacts, reward_terms
from rigid.tasks.itch_scratching.sensing import Contacts
from rigid.tasks.physics.reward import HIGH_FORCE
from tests.tasks.scripted import random_actions


def contacts(**changes):
    """One world, two physics steps: a gentle touch of the itch, 2 cm from the origin."""
    values = {
        "force_on_person": np.array([[1.0, 3.0]]),
        "force_unwanted": np.zeros((1, 2)),
        "touched_unwanted": np.array([False]),
        "force_itch": np.array([[1.0, 3.0]]),
        "itch_touched": np.array([True]),
        "itch_contact": np.array([[0.02, 0.0, 0.0]]),
        "tool_force": np.array([3.0]),
    }
    return Contacts(**{**values, **changes})


def counts(last=(0.0, 0.0, 0.0), **changes):
    return bool(counted_contacts(contacts(**changes), np.array([last]))[0])


def terms(weights=None, **changes):
    values = {
        "distance": np.array([0.0]),
        "counted": np.array([False]),
        "action": np.zeros((1, 17)),
        "end_effector_speed": np.array([0.0]),
        "contacts": contacts(force_on_person=np.zeros((1, 2)), force_itch=np.zeros((1, 2))),
    }
    return {
        name: value[0]
        for name, value in reward_terms(weights or RewardWeights(), **{**values, **changes}).items()
    }


def test_a_gentle_touch_of_the_itch_in_a_new_place_counts():
    assert counts()


def test_no_contact_does_not_count():
    assert not counts(itch_touched=np.array([False]))


@pytest.mark.parametrize(
    ("peak", "expected"), [(HIGH_FORCE, False), (np.nextafter(HIGH_FORCE, 0), True)]
)
def test_ten_newtons_are_too_hard(peak, expected):
    assert counts(force_itch=np.array([[peak, 0.0]])) is expected
    assert counts(force_itch=np.array([[0.0, peak]])) is expected


@pytest.mark.parametrize(("moved", "expected"), [(MOVED, False), (np.nextafter(MOVED, 1), True)])
def test_a_contact_must_have_moved_more_than_a_centimetre(moved, expected):
    assert counts(itch_contact=np.array([[0.0, 0.0, moved]])) is expected


def test_distance_is_taken_from_the_last_counted_contact():
    assert not counts(last=(0.025, 0.0, 0.0))
    assert counts(last=(0.031, 0.0, 0.0))


def test_a_touch_without_force_counts():
    assert counts(force_itch=np.zeros((1, 2)))


def test_distance_costs_by_the_metre():
    assert terms(distance=np.array([0.2]))["distance"] == pytest.approx(-0.6)


def test_a_counted_contact_pays_five():
    assert terms(counted=np.array([True]))["scratch"] == 5


def test_actions_cost_by_their_norm():
    action = np.zeros((1, 17))
    action[0, [0, 16]] = 3.0, 4.0
    assert terms(action=action)["action"] == pytest.approx(-0.05)


def test_speed_of_the_end_effector_costs():
    assert terms(end_effector_speed=np.array([2.0]))["velocity"] == pytest.approx(-0.5)


def test_force_away_from_the_itch_costs_its_mean_over_the_step():
    force = contacts(force_on_person=np.array([[5.0, 9.0]]), force_itch=np.array([[1.0, 3.0]]))
    assert terms(contacts=force)["other_force"] == pytest.approx(-0.05)


@pytest.mark.parametrize(("peak", "cost"), [(9.99, 0.0), (10.0, -0.5), (40.0, -2.0)])
def test_from_ten_newtons_on_the_peak_at_the_itch_costs(peak, cost):
    force = contacts(force_itch=np.array([[0.0, peak]]))
    assert terms(contacts=force)["high_force"] == pytest.approx(cost)


def test_touching_anything_but_the_arms_costs_a_fixed_amount():
    touched = contacts(touched_unwanted=np.array([True]))
    assert terms(contacts=touched)["unwanted_contact"] == -2


def test_every_weight_has_a_term_of_its_name():
    names = set(terms())
    for name in names:
        weights = RewardWeights(**{name: 1000.0})
        loud = terms(
            weights,
            distance=np.array([1.0]),
            counted=np.array([True]),
            action=np.ones((1, 17)),
            end_effector_speed=np.array([1.0]),
            contacts=contacts(
                force_on_person=np.array([[30.0, 30.0]]),
                force_itch=np.array([[0.0, 20.0]]),
                touched_unwanted=np.array([True]),
            ),
        )
        assert [n for n in names if abs(loud[n]) > 500] == [name]


def test_the_reward_is_the_sum_of_its_named_terms(task):
    world, rng = task.make_world(8, threads=1), np.random.default_rng(0)
    world.reset(np.arange(8))
    for _ in range(20):
        step = world.step(*random_actions(rng, 8))
        named = [v for name, v in step.info.items() if name.startswith("reward_")]
        np.testing.assert_allclose(np.sum(named, axis=0), step.reward, rtol=1e-12)
