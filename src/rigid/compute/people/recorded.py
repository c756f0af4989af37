"""Episodes that somebody recorded: how natural they are, and what they looked like.

A recording holds no states, but all that makes them: the seed of each start and the human's
actions. Against the robot that it was recorded with, which acts by its mean, the episode comes out
again. Another robot is noticed, since then the return does not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.compute.canonical import chosen_features
from rigid.compute.referee.files import load_panel
from rigid.compute.run.directory import RunDirectory
from rigid.data.episodes import CanonicalEpisodes
from rigid.errors import UserError
from rigid.learning.rollout import Actor, Trajectories, play, policy_actor
from rigid.naturalness.features import choose_features
from rigid.naturalness.panel import Panel
from rigid.naturalness.strictest import UpperBound, strictest_naturalness
from rigid.naturalness.views import all_sound
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Step, Task, World

RETURN_TOLERANCE = 0.05
"""Largest difference between the return of an episode and that of its replay, as a share of the
range of adversarialness. Ours: a sixth of the difference that makes two episodes unlike (0.3)."""


class Replayed(NamedTuple):
    """Recorded episodes, played again."""

    states: Float[np.ndarray, "E T1 state"]
    """Snapshots after the reset and after each step."""
    returns: Float[np.ndarray, " E"]


def stored_panels(run: Path, points: Sequence[str]) -> list[Panel]:
    """The referees that judged the adversaries of a run.

    Raises:
        UserError: Their files are missing or damaged, or a point's id is none.
    """
    names = [RunDirectory(run).adversary(point).name for point in points]
    return [load_panel(run / "referee", name) for name in names]


def judge_recording(
    panels: Sequence[Panel],
    features: str,
    task: Task,
    recording: CanonicalEpisodes,
    *,
    where: Path,
) -> UpperBound:
    """How natural the human of a recording is at most, by referees that runs stored.

    Args:
        panels: Of the runs that measured the robot which the human met (`stored_panels`).
        features: What those referees see: `features` of the runs' identity.
        task: The runs'.
        recording: Episodes of one human in that task.
        where: Its file, for messages.

    Raises:
        UserError: There are fewer than two episodes, or they lack what the features are made of.
    """
    if len(recording) < 2:
        raise UserError(
            f"{where} holds 1 episode, but one half of them chooses the strictest referee and the "
            "other half is judged: record at least 2"
        )
    chosen = chosen_features(choose_features(features, task), recording, where)
    return strictest_naturalness(panels, all_sound(chosen))


def replay_recording(
    task: Task, robot: Policy, recording: CanonicalEpisodes, *, where: Path
) -> Replayed:
    """Plays recorded episodes again with `robot`, which may be another one than they met.

    Args:
        task: The task that they were recorded in.
        robot: Acts by its mean, as in every measurement.
        recording: Whose human acts as it did.
        where: Its file, for messages.

    Raises:
        UserError: Nobody recorded the human's actions, or the seeds.
    """
    states: list[np.ndarray] = []
    world = task.make_world(len(recording))

    def watch(*_: object) -> None:
        states.append(world.snapshot())

    played = play_again(task, robot, recording, where=where, world=world, watch=watch)
    returns = np.where(played.faulted > 0, np.nan, played.returns)  # A fault is no return.
    return Replayed(np.stack(states).swapaxes(0, 1), returns)


def play_again(
    task: Task,
    robot: Policy,
    recording: CanonicalEpisodes,
    *,
    where: Path,
    world: World | None = None,
    watch: Callable[[int, Step], None] | None = None,
) -> Trajectories:
    """As `replay_recording`: what both saw and did, step by step.

    Args:
        task: The task that they were recorded in.
        robot: Acts by its mean.
        recording: Whose human acts as it did.
        where: Its file, for messages.
        world: A world for each episode; by default a new one.
        watch: Called with the step number (0 after the reset) and the step.

    Raises:
        UserError: Nobody recorded the human's actions, or the seeds.
    """
    if recording.provenance.get("seeds") == "numbered":
        raise UserError(
            f"{where} has no column 'seed', so nobody knows how its episodes began, and a robot "
            "cannot play them again: leave the robot out, or record the seeds"
        )
    if recording.actions is None:
        raise UserError(
            f"{where} holds no actions of the human, so nobody can see its episodes again: record "
            "them as well, as `rigid record` does"
        )
    return play(
        task, world or task.make_world(len(recording)), recording.seeds,
        policy_actor(robot, len(recording), None), _again(recording.actions), watch=watch,
    )  # fmt: skip


def reproduced(
    recording: CanonicalEpisodes, replayed: Replayed, return_range: Sequence[float]
) -> bool:
    """Whether every episode of known return came out again; of another robot's they do not."""
    worst, best = return_range
    known = ~np.isnan(recording.returns)
    apart = np.abs(recording.returns - replayed.returns)[known]
    return bool((apart <= RETURN_TOLERANCE * (best - worst)).all())


def _again(actions: Float[np.ndarray, "E T a"]) -> Actor:
    """Does what was done before, step by step, whatever it sees."""
    steps = iter(actions.swapaxes(0, 1))
    return lambda _: next(steps)
