"""Canonical episodes from policies: a robot and a synthetic human play, and the human is kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import islice
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from rigid.data.about import About
from rigid.data.episodes import CanonicalEpisodes
from rigid.errors import UserError
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.policies.discrete import taken
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task, World, control_period, feature_units

BATCH = 100
"""Episodes played side by side."""


class _Block(NamedTuple):
    """The episodes of one set of worlds."""

    seeds: np.ndarray
    episodes: Trajectories


def record(
    task: Task,
    robot: Policy,
    human: Policy,
    *,
    episodes: int,
    seed: int,
    batch: int = BATCH,
    provenance: Mapping[str, Any],
) -> CanonicalEpisodes:
    """Plays `episodes` episodes and keeps what the human did.

    The robot takes its mean action; the human is sampled. Episodes are played in blocks of exactly
    `batch` worlds, since compiled sums differ in the last digits with the width; what a last block
    plays too much is dropped. Block b draws starts and noise from (`seed`, b) alone, so episode i
    depends on `seed`, i and `batch`, and a longer recording begins with the shorter one. Episodes
    whose physics ran away are dropped and the next ones take their place; `faulted_episodes` in
    the provenance counts them.

    Args:
        task: The world to play in.
        robot: Acts for the robot.
        human: Acts for the human.
        episodes: How many to keep.
        seed: At least 0.
        batch: Worlds in a block; part of the numbers' identity.
        provenance: Hashes of robot and human and the like; `seed`, `batch` and
            `faulted_episodes` are added.

    Raises:
        UserError: Twice as many episodes as asked for did not give enough that did not run away.
        ValueError: `episodes`, `seed` or `batch` is out of range.
    """
    for name, value, least in (("episodes", episodes, 1), ("seed", seed, 0), ("batch", batch, 1)):
        if value < least:
            raise ValueError(f"{name} must be at least {least}, got {value}")
    blocks: list[_Block] = []
    sound = np.zeros(0, dtype=bool)
    for block in islice(_blocks(task, robot, human, seed, batch), ceil(2 * episodes / batch)):
        blocks.append(block)
        sound = np.append(sound, block.episodes.faulted == 0)
        if sound.sum() >= episodes:
            break
    else:
        raise UserError(
            f"{len(sound) - sound.sum()} of {len(sound)} episodes of task {task.name!r} ran away: "
            "record with a gentler policy or a smaller physics step"
        )
    kept = np.flatnonzero(sound)[:episodes]
    made_by = {"seed": seed, "batch": batch, "faulted_episodes": int(kept[-1]) + 1 - episodes}
    return _keep(task, blocks, kept, {**provenance, **made_by})


def _blocks(task: Task, robot: Policy, human: Policy, seed: int, batch: int) -> Iterator[_Block]:
    """Sets of `batch` episodes without end."""
    world: World = task.make_world(batch)
    number = 0
    while True:
        # Two words of entropy: neither seed nor block can be mistaken for the other's.
        starts, noise = np.random.SeedSequence([seed, number]).spawn(2)
        seeds = starts.generate_state(batch).astype(np.int64)
        robot_actor = policy_actor(robot, batch, None)
        human_actor = policy_actor(human, batch, np.random.default_rng(noise))
        yield _Block(seeds, play(task, world, seeds, robot_actor, human_actor))
        number += 1


def _keep(
    task: Task, blocks: list[_Block], kept: np.ndarray, provenance: Mapping[str, Any]
) -> CanonicalEpisodes:
    played = [block.episodes for block in blocks]

    def by_episode(arrays: list[np.ndarray]) -> np.ndarray:
        """Joins blocks [T, batch, …] to the kept episodes [E, T, …]."""
        joined: np.ndarray = np.concatenate(arrays, axis=1).swapaxes(0, 1)[kept]
        return joined

    return CanonicalEpisodes(
        features=by_episode([block.features for block in played]),
        observations=by_episode([block.human_observation for block in played]),
        actions=taken(by_episode([block.human_action for block in played]), task.human),
        seeds=np.concatenate([block.seeds for block in blocks])[kept],
        returns=np.concatenate([block.returns for block in played])[kept],
        success=np.concatenate([block.summary.success for block in played])[kept],
        task=task.describe(),
        feature_names=tuple(task.feature_names),
        source="synthetic",
        provenance=provenance,
        control_period=control_period(task),
        about=About(units=dict(feature_units(task))),
    )
