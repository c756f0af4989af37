"""The study from its plan to its account."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from benchmarks.prediction.account import account
from benchmarks.prediction.assembling import Subject, human_rows, table_rows
from benchmarks.prediction.associations import correlation_rows, difference_rows
from benchmarks.prediction.drawing import draw
from benchmarks.prediction.making import Workplace
from benchmarks.prediction.plan import Plan
from benchmarks.prediction.predictors import numbers_of, redrawn
from benchmarks.robots import RobotPlan
from benchmarks.study import say, write_table
from rigid.commands.parsing import spoken
from rigid.compute.budget import FIXED_SECONDS, training_speed
from rigid.compute.run.directory import alone_in
from rigid.errors import UserError
from rigid.files import write_atomically
from rigid.policies.native import CARD_FILE

_FIXED = {"pair": 25.0, "robot": 6.0, "meeting": 1.0}
"""Compilation and loading [s], for the estimate of time only (seen on two busy cores)."""
_PLAYING = 0.5
"""Time of an episode that is played, over that of one that is learned from; for the estimate too.
"""


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Makes what is missing in `out`, then writes everything into `results`.

    Raises:
        UserError: `out` holds parts of another plan, a directory cannot be written, or another
            process is at it.
    """
    try:
        results.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(
            f"cannot write to {results} ({error.strerror}): choose another place with --results"
        ) from None
    with alone_in(out):
        place = Workplace(plan, out)
        seconds = expected_seconds(place, training_speed(place.task))
        humans = len(plan.humans())
        say(f"{len(plan.robots)} robots, {humans} unseen humans; about {spoken(seconds)}")
        subjects = _make(place)
    say("correlating")
    _write(plan, subjects, results)
    say(f"written: {results / 'README.md'}")


def _make(place: Workplace) -> list[Subject]:
    """All that takes long, the cheap parts first."""
    for robot in place.plan.robots:
        place.make_robot(robot)
    for seed in place.plan.pairs:
        place.make_pair(seed)
    return [_subject(place, robot, number) for number, robot in enumerate(place.plan.robots)]


def _write(plan: Plan, subjects: Sequence[Subject], results: Path) -> None:
    humans = plan.humans()
    rows = {
        "table": table_rows(subjects, humans),
        "humans": human_rows(subjects, humans),
        "correlations": correlation_rows(subjects, humans, resamples=plan.resamples),
        "differences": difference_rows(subjects, humans, resamples=plan.resamples),
    }
    for name, table in rows.items():
        write_table(results / f"{name}.csv", table)
    draw(results / "figure.svg", rows["table"])
    text = account(plan, rows["table"], rows["humans"], rows["correlations"], rows["differences"])
    write_atomically(results / "README.md", text.encode())


def _subject(place: Workplace, robot: RobotPlan, number: int) -> Subject:
    """One robot, measured and met."""
    frontier = place.measure(robot)
    return Subject(
        plan=robot,
        frontier=frontier,
        numbers=numbers_of(frontier),
        redrawn=redrawn(frontier, place.plan.redraws, np.random.default_rng(number)),
        meetings={human.name: place.meet(robot, human) for human in place.plan.humans()},
    )


def expected_seconds(place: Workplace, speed: float) -> float:
    """How long what is missing will take, at `speed` training steps per second."""
    plan, horizon = place.plan, place.task.horizon
    robots = [robot for robot in plan.robots if not (place.robot(robot) / CARD_FILE).exists()]
    pairs = _missing(place.pair(seed) / "human" / CARD_FILE for seed in plan.pairs)
    frontiers = _missing(place.frontier(robot) / "frontier.json" for robot in plan.robots)
    meetings = _missing(
        place.meeting(robot, human) for robot in plan.robots for human in plan.humans()
    )
    episodes = (
        sum(robot.iterations for robot in robots) * plan.training.episodes
        + pairs * plan.pair_settings.iterations * plan.pair_settings.episodes
        + frontiers * plan.preset.env_steps(horizon) / horizon
        + meetings * plan.episodes * _PLAYING
    )
    fixed = (
        len(robots) * _FIXED["robot"]
        + pairs * _FIXED["pair"]
        + frontiers * FIXED_SECONDS
        + meetings * _FIXED["meeting"]
    )
    return fixed + episodes * horizon / speed


def _missing(paths: Iterable[Path]) -> int:
    return sum(not path.exists() for path in paths)
