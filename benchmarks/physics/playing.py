"""Closed loop: the same starts, the same noise, policies that act at every step size."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from benchmarks.physics.people import human_named, robot
from benchmarks.physics.plan import Plan, Setting
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.tasks.itch_scratching.sensing import Poses
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.itch_scratching.world import ItchScratchingWorld
from rigid.tasks.protocol import Step

_SEEDS = 2**31
"""Seeds of starts lie below it, as in `rigid evaluate`."""


class WatchedWorld(ItchScratchingWorld):
    """A world that notes the deepest overlap and the fastest joint of each episode.

    Its poses may be older than the last physics step, as old as those of a coarser one: what is
    left of a difference then is no matter of what the policies see.
    """

    def __init__(self, task: ItchScratching, batch: int, *, pose_age: int = 1) -> None:
        """Makes `batch` worlds.

        Args:
            task: Itch scratching at some step.
            batch: Number of worlds.
            pose_age: Of poses and distances [physics steps]; the task has 1.
        """
        super().__init__(task, batch, threads=1)
        self._pose_age = pose_age
        self.penetration, self.fastest = np.zeros(batch), np.zeros(batch)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world."""
        self.penetration, self.fastest = np.zeros(self.batch), np.zeros(self.batch)
        return super().reset(seeds)

    def step(
        self, robot_action: Float[np.ndarray, "B 7"], human_action: Float[np.ndarray, "B 10"]
    ) -> Step:
        """Advances every world by one control step; nothing is noted of one that ran away."""
        result = super().step(robot_action, human_action)
        sound = ~self.faulted
        depth = self._scene.penetration(self._scene.records["sensordata"])
        speed = np.abs(self._batch.bind("qvel")).max(axis=1)
        self.penetration = np.maximum(self.penetration, np.where(sound, depth, 0.0))
        self.fastest = np.maximum(self.fastest, np.where(sound, speed, 0.0))
        return result

    def _poses(self, data: Float[np.ndarray, "B S n"]) -> Poses:
        return super()._poses(data[:, : max(1, data.shape[1] - self._pose_age + 1)])


class Played(NamedTuple):
    """Episodes and what else was noted of them."""

    episodes: Trajectories
    penetration: Float[np.ndarray, " N"]
    """Deepest overlap [m]."""
    fastest: Float[np.ndarray, " N"]
    """Fastest joint at the end of a control step [rad/s]."""
    snapshots: Float[np.ndarray, "T1 N state"]


def task_at(setting: Setting) -> ItchScratching:
    """Itch scratching with another physics step."""
    return ItchScratching().with_parameters(
        physics_step=setting.step, substeps=setting.substeps
    )  # fmt: skip


def play_block(
    pair: str, setting: Setting, *, count: int, seed: int, block: int, pose_age: int = 1
) -> Played:
    """Plays `count` episodes; equal (`seed`, `block`) give equal starts and noise at every step.

    The robot acts by its mean and the human samples, as in every measurement.
    """
    starts, rng = starts_of(count, seed=seed, block=block)
    task, human = task_at(setting), human_named(pair, starts)
    world = WatchedWorld(task, count, pose_age=pose_age)
    snapshots: list[np.ndarray] = []
    episodes = play(
        task, world, starts, policy_actor(robot(), count, None), policy_actor(human, count, rng),
        watch=lambda _number, _step: snapshots.append(world.snapshot()),
    )  # fmt: skip
    return Played(episodes, world.penetration, world.fastest, np.stack(snapshots))


def starts_of(
    count: int, *, seed: int, block: int
) -> tuple[Int[np.ndarray, " N"], np.random.Generator]:
    """Seeds of a block's starts, and the generator that its noise goes on with."""
    rng = np.random.default_rng([seed, block])
    return rng.integers(_SEEDS, size=count), rng


def play_closed(
    pair: str, setting: Setting, plan: Plan, *, like: Setting | None = None
) -> dict[str, Any]:
    """All episodes of a pair at one step: a list with a value for each of them, by number.

    Args:
        pair: Name of its human.
        setting: The physics step.
        plan: Number of episodes.
        like: The step as old as which poses are; by default `setting`.
    """
    age = round((like or setting).step / setting.step)
    blocks = []
    for block, size in enumerate(block_sizes(plan.episodes[pair], plan.block)):
        played = play_block(
            pair, setting, count=size, seed=plan.seed, block=block, pose_age=age
        )  # fmt: skip
        blocks.append(_numbers(played, plan.window))
    return {name: np.concatenate([block[name] for block in blocks]).tolist() for name in blocks[0]}


def block_sizes(episodes: int, block: int) -> list[int]:
    """Episodes in each block.

    Example:
        >>> block_sizes(250, 100)
        [100, 100, 50]
    """
    return [min(block, episodes - begun) for begun in range(0, episodes, block)]


def _numbers(played: Played, moment: int) -> dict[str, np.ndarray]:
    episodes, summary = played.episodes, played.episodes.summary
    return {
        "return": episodes.returns,
        "success": summary.success,
        "counted": summary.extra["counted_contacts"],
        "peak_force": summary.peak_force,
        "impulse": summary.impulse,
        "penetration": played.penetration,
        "fastest": played.fastest,
        "faulted": episodes.faulted,
        "angles": episodes.features[moment - 1, :, :10],
    }
