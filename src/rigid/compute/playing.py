"""Playing episodes from given starts, with one human or several, in as many turns as it takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Int, Shaped

from rigid.learning.rollout import Actor, Trajectories, play, policy_actor
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import LimitsWorlds, Summary, Task


def play_with(
    task: Task,
    robot: Policy,
    human: Actor,
    starts: Int[np.ndarray, " n"],
    *,
    humans: int = 1,
    snapshots: list[np.ndarray] | None = None,
    threads: int = 0,
) -> Trajectories:
    """Plays episodes from `starts` with each of several humans, in one set of worlds.

    Args:
        task: The task.
        robot: Acts by its mean.
        human: Acts for all humans at once; their worlds follow one another in equal blocks.
        starts: Episode seeds, the same for every human.
        humans: How many there are.
        snapshots: Is given one entry a step, for replays.
        threads: That step the worlds; 0: every core.
    """
    seeds = np.tile(starts, humans)
    world = task.make_world(len(seeds), threads=threads)

    def keep(*_: object) -> None:
        if snapshots is not None:
            snapshots.append(world.snapshot())

    actor = policy_actor(robot, len(seeds), None)
    return play(task, world, seeds, actor, human, watch=keep)


def play_in_turns(
    task: Task,
    robot: Policy,
    human: Callable[[int], Actor],
    starts: Int[np.ndarray, " n"],
    *,
    humans: int = 1,
    snapshots: list[np.ndarray] | None = None,
    threads: int = 0,
) -> Trajectories:
    """As `play_with`, with no more worlds at a time than the task allows, if it says anything.

    Args:
        task: The task.
        robot: As in `play_with`, like all others but `human`.
        human: Makes the actor of so many worlds; asked once for each turn.
        starts: Likewise.
        humans: Likewise.
        snapshots: Likewise.
        threads: Likewise.
    """
    count = _turns(task, humans, len(starts))
    if count == 1:
        return play_with(
            task, robot, human(humans * len(starts)), starts, humans=humans, threads=threads,
            snapshots=snapshots,
        )  # fmt: skip
    turns = np.array_split(starts, count)
    films: list[list[np.ndarray]] = [[] for _ in turns]
    played = [
        play_with(
            task, robot, human(humans * len(turn)), turn, humans=humans, threads=threads,
            snapshots=None if snapshots is None else film,
        )
        for turn, film in zip(turns, films, strict=True)
    ]  # fmt: skip
    order = _order([len(turn) for turn in turns], humans)
    if snapshots is not None:
        snapshots += [np.concatenate(moments)[order] for moments in zip(*films, strict=True)]
    return _joined(played, order)


def _turns(task: Task, humans: int, starts: int) -> int:
    """How many turns it takes; a turn has a world for each human at least."""
    if not isinstance(task, LimitsWorlds):
        return 1
    return -(-starts // max(task.most_worlds // humans, 1))


def _order(turns: Sequence[int], humans: int) -> Int[np.ndarray, " N"]:
    """Where episodes that were played in turns of so many starts come from, human by human."""
    place = np.cumsum([0, *(humans * starts for starts in turns)])
    return np.concatenate([
        place[turn] + human * starts + np.arange(starts)
        for human in range(humans) for turn, starts in enumerate(turns)
    ])  # fmt: skip


def _joined(played: Sequence[Trajectories], order: Int[np.ndarray, " N"]) -> Trajectories:
    def join(parts: Sequence[Shaped[np.ndarray, "..."]], axis: int) -> Shaped[np.ndarray, "..."]:
        return np.take(np.concatenate(parts, axis), order, axis)

    *columns, summaries = zip(*played, strict=True)
    *numbers, extras = zip(*summaries, strict=True)
    ended = dict(zip(Summary._fields, (join(parts, 0) for parts in numbers), strict=False))
    extra = {name: join([one[name] for one in extras], 0) for name in extras[0]}
    seen = dict(zip(Trajectories._fields, (join(parts, 1) for parts in columns), strict=False))
    return Trajectories(**seen, summary=Summary(**ended, extra=extra))
