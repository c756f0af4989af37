"""The kinds that real episodes of the bundled robot get with humans whose fault is known."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.learning.rollout import play, policy_actor
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy
from rigid.report.episodes import arm_of, read_episode
from rigid.report.failure_rules import classify
from rigid.tasks.bodies import human as body
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.tasks.mistaken import mistaken

STARTS = np.array([0, 2, 4])


@pytest.fixture(scope="module")
def task():
    return ItchScratching()


@pytest.fixture(scope="module")
def played(task):
    """Episodes of the bundled robot with a human, for whom `make(world)` acts."""
    robot = load_policy("builtin:vanilla", task=task, agent="robot")
    scene = task.scene()

    def episodes(make):
        world, snapshots = task.make_world(len(STARTS)), []
        played = play(
            task, world, STARTS, policy_actor(robot, len(STARTS), None), make(world),
            watch=lambda *_: snapshots.append(world.snapshot()),
        )  # fmt: skip
        names = [task.outcome_names[outcome] for outcome in played.summary.outcome]
        films = np.stack(snapshots).swapaxes(0, 1)
        return [
            read_episode(scene, {**task.replay(film), "outcome": name})
            for film, name in zip(films, names, strict=True)
        ]

    return episodes


@pytest.fixture(scope="module")
def synthetic(task):
    human = load_policy("builtin:synthetic-human", task=task, agent="human")
    assert isinstance(human, GaussianPolicy)
    return human


@pytest.fixture(scope="module")
def canonical(played, synthetic):
    rng = np.random.default_rng(0)
    return played(lambda _: lambda observation: synthetic.act(observation, (), rng)[0])


def kinds(episodes, canonical):
    found = [classify(*pair) for pair in zip(episodes, canonical, strict=True)]
    return [failure and failure["kind"] for failure in found]


def holding(**actions):
    """A human who holds some joints' actions, whatever happens."""
    action = np.zeros((len(STARTS), len(body.ARM_JOINTS)), np.float32)
    for joint, value in actions.items():
        action[:, body.ARM_JOINTS.index(joint)] = value
    return lambda _: lambda _: action


def test_canonical_play_does_not_fail(canonical):
    assert kinds(canonical, canonical) == [None] * 3
    assert {episode.name(episode.itching) for episode in canonical} == {
        "right upper arm", "right forearm",
    }  # fmt: skip


def test_a_human_who_acts_for_the_other_itch_is_scratched_on_the_wrong_limb(
    task, played, canonical, synthetic
):
    rng = np.random.default_rng(1)
    misled = played(lambda world: mistaken(task, world, synthetic, rng))
    assert kinds(misled, canonical) == ["wrong_limb"] * 3


def test_a_human_who_does_nothing_leaves_the_robot_waiting(played, canonical):
    assert set(kinds(played(holding()), canonical)) <= {"stuck", "too_little"}


def test_the_robot_leaves_a_human_who_spreads_the_arm(played, canonical):
    assert kinds(played(holding(shoulder_x=1)), canonical) == ["strayed"] * 3


def test_the_arm_is_as_long_as_the_jaco_with_its_tool(canonical):
    arm = arm_of(canonical)
    links = [0.205, 0.205, 0.2073, 0.10375, 0.10375]  # [m], between the origins of links 2 to 7.
    assert arm.length == pytest.approx(sum(links) + 0.16 + 0.095, abs=2e-3)
    np.testing.assert_allclose(arm.shoulder, [-0.35, -0.30, 0.36 + 0.15675 + 0.11875], atol=3e-3)
