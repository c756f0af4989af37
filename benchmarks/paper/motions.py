"""How the humans of differently seeded pairs move (paper, appendix B, its figure of four pairs)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.paper.drawing import Motion
from rigid.learning.rollout import play, policy_actor
from rigid.policies.loading import load_policy
from rigid.robots.storing import privileged_view
from rigid.tasks.bodies.human import ARM_JOINTS
from rigid.tasks.itch_scratching.task import ItchScratching

EPISODES = 6
_SEED = 2**21
"""Of the episodes that are drawn. Ours."""


def motion_of(task: ItchScratching, seed: int, robot: Path, human: Path) -> Motion:
    """Some episodes of a pair as it was co-optimised: the robot sees the itch.

    Args:
        task: Where the pair was trained.
        seed: Of the pair.
        robot: Its robot.
        human: Its human.
    """
    world = privileged_view(task)
    rng = np.random.default_rng(_SEED)
    actors = [
        policy_actor(load_policy(str(robot), task=world, agent="robot"), EPISODES, None),
        policy_actor(load_policy(str(human), task=task, agent="human"), EPISODES, rng),
    ]
    starts = rng.integers(2**31, size=EPISODES)
    episodes = play(world, world.make_world(EPISODES), starts, *actors)
    seen = np.swapaxes(episodes.human_observation, 0, 1)
    features = np.swapaxes(episodes.features, 0, 1)
    return Motion(
        seed=seed,
        joints=ARM_JOINTS,
        angles=features[..., [_column(task.feature_names, joint) for joint in ARM_JOINTS]],
        limits=np.array([task.model.joint(joint).range for joint in ARM_JOINTS]),
        wrist=seen[..., _points(task.human.observation_names, "wrist_position")],
        tip=seen[..., _points(task.human.observation_names, "tip")],
    )


def _column(names: Sequence[str], name: str) -> int:
    return list(names).index(name)


def _points(names: Sequence[str], point: str) -> list[int]:
    return [_column(names, f"{point}_{axis}") for axis in "xyz"]
