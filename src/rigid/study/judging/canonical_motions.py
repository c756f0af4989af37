"""Canonical episodes for people to watch before they play or judge."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Int

from rigid.compute.people.recorded import replay_recording, reproduced
from rigid.compute.subject import Subject, canonical_path
from rigid.data.episodes import CanonicalEpisodes, data_hash, load_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task

HUMAN = "builtin:synthetic-human"
_TRIES = 5
"""Episodes to choose each successful one from. Ours: robots that help in less than one of five
are not what people should be shown as success."""


class CanonicalOrder(NamedTuple):
    """Episodes of one robot that people watch."""

    task: Task
    spec: str
    """Names the robot."""
    robot: Policy
    episodes: int
    seed: int


def shows(order: CanonicalOrder) -> dict[str, Any]:
    """What the motions show: equal ones are the same."""
    path = _file(order)
    source: Mapping[str, Any] = (
        {
            "seed": order.seed,
            "human": policy_hash(load_policy(HUMAN, task=order.task, agent="human")),
        }
        if path is None
        else {"canonical": data_hash(load_episodes(path, task=order.task))}
    )
    task = dict(order.task.describe())
    return {"task": task, "robot": policy_hash(order.robot), "episodes": order.episodes, **source}


def canonical_replays(order: CanonicalOrder) -> list[Mapping[str, Any]]:
    """Successful canonical episodes (section 5.2), replayed.

    They are the first of those that lie beside the robot, recorded from people or not, else those
    of the synthetic human, drawn from the seed.

    Raises:
        UserError: Too few succeed, or they were recorded with another robot.
    """
    path = _file(order)
    where = path or Path(HUMAN)
    episodes = _recorded(order) if path is None else load_episodes(path, task=order.task)
    helped = np.flatnonzero(episodes.success != 0)  # NaN where the task defines no success.
    if len(helped) < order.episodes:
        raise UserError(
            f"{len(helped)} of {len(episodes)} canonical episodes of robot {order.spec!r} "
            f"and {where} succeed, but people watch {order.episodes}: ask for fewer, or put "
            "episodes of its own human beside the robot (canonical.npz)"
        )
    chosen = _taken(episodes, helped[: order.episodes])
    played = replay_recording(order.task, order.robot, chosen, where=where)
    bounds = order.task.return_range
    if bounds is not None and not reproduced(chosen, played, bounds):
        raise UserError(
            f"{where} was recorded with another robot than {order.spec!r}: played again, its "
            "episodes do not return the same; record them again with `rigid record`"
        )
    return [order.task.replay(states) for states in played.states]


def _file(order: CanonicalOrder) -> Path | None:
    return canonical_path(Subject(order.task, order.spec))


def _recorded(order: CanonicalOrder) -> CanonicalEpisodes:
    human = load_policy(HUMAN, task=order.task, agent="human")
    tries = _TRIES * order.episodes
    return record(
        order.task, order.robot, human, episodes=tries, seed=order.seed, batch=tries, provenance={}
    )


def _taken(episodes: CanonicalEpisodes, kept: Int[np.ndarray, " n"]) -> CanonicalEpisodes:
    def of(values: np.ndarray | None) -> np.ndarray | None:
        return None if values is None else values[kept]

    return replace(
        episodes, features=episodes.features[kept], seeds=episodes.seeds[kept],
        returns=episodes.returns[kept], success=episodes.success[kept],
        observations=of(episodes.observations), actions=of(episodes.actions),
        rewards=of(episodes.rewards), times=of(episodes.times),
    )  # fmt: skip
