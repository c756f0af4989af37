"""`rigid train robust-gt --rounds N`: measure, retrain, measure again.

Beyond the paper: does robustness really grow, or does the hole only move? Every round's robot is
searched with seeds of its own, and learns from what all searches before it found. Whether it grew
is judged by a search with seeds that no training saw.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from rigid.compute.listening import Listener
from rigid.compute.measurement import measure_robot
from rigid.compute.return_range import stored_range
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.compute.subject import Subject
from rigid.frontier.result import load_frontier
from rigid.presets import Preset
from rigid.robots.robust_gt import RobustSettings, making_of, take_lesson, train_robust_gt
from rigid.robots.storing import Report, already_made, open_training, refuse_finished
from rigid.tasks.protocol import Task

Showing = Callable[[str], AbstractContextManager[Report]]
Listening = Callable[[str], AbstractContextManager[Listener]]


@dataclass(frozen=True)
class Manner:
    """How a run searched, but for its budget and seeds."""

    features: str
    search_measure: str
    memory: int
    lambdas: tuple[float, ...] | None
    """Exactly these; None where the search chose them."""

    @classmethod
    def of(cls, run: Path) -> Manner:
        """That of a finished run."""
        identity = read_settings(RunDirectory(run))["identity"]
        lambdas = identity["lambdas"]
        return cls(
            identity["features"], identity["measure"], identity["adversary"]["memory"],
            None if lambdas is None else tuple(map(float, lambdas)),
        )  # fmt: skip


def seeds_not_used(runs: Sequence[Path], count: int) -> tuple[int, ...]:
    """Search seeds above all that these runs have."""
    used = [seed for run in runs for seed in read_settings(RunDirectory(run))["seeds"]]
    first = max(used) + 1
    return tuple(range(first, first + count))


def train_in_rounds(
    run: Path,
    settings: RobustSettings,
    preset: Preset,
    *,
    rounds: int,
    seed: int,
    out: Path,
    canonical_episodes: int,
    robot: str | None,
    training: Showing,
    searching: Listening,
    task: Task | None = None,
) -> list[Path]:
    """Trains a robot into `out`; the robots and searches between lie in `out`/round-1 and so on.

    Args:
        run: The finished measurement that it begins with.
        settings: Of every training.
        preset: Of the searches between; all else of them is as in `run`, but that canonical play is
            with the new robot.
        rounds: Trainings in all; 1 is the paper's Robust GT.
        seed: Everything random comes from it.
        out: Directory of the last robot.
        canonical_episodes: Recorded with each robot.
        task: The run's, if the user named it.
        robot: Where the robot that `run` measured is now; by default where it was.
        training: Shows the progress of a training, which it is told the name of.
        searching: Shows the progress of a search.

    Returns:
        Every run that the last robot learned from.

    Raises:
        UserError: As `take_lesson` and `train_robust_gt`.
    """
    runs, between = [run], [f"round-{number}" for number in range(1, rounds)]
    # Refuses what cannot be learned from, before any work.
    take_lesson(runs, settings, task=task, robot=robot)
    refuse_finished(out)
    open_training(out, between)
    measured = load_frontier(run).data
    human, manner = str(measured["human"]), Manner.of(run)
    teach = partial(
        train_robust_gt, settings=settings, seed=seed, canonical_episodes=canonical_episodes
    )
    for name in between:
        made, searched = out / name / "robot", out / name / "frontier"
        lesson = take_lesson(runs, settings, task=task, robot=robot)
        if not already_made(made, lesson.task, making_of(lesson, settings, seed)):
            with training(name) as report:
                teach(lesson, out=made, report=report)
        with searching(name) as listener:
            measure_robot(
                Subject(
                    lesson.task, str(made), human,
                    features=manner.features, return_range=stored_range(measured),
                ),
                preset, out=searched, seeds=seeds_not_used(runs, len(preset.seeds)),
                lambdas=manner.lambdas, memory=manner.memory,
                search_measure=manner.search_measure, listener=listener,
            )  # fmt: skip
        runs.append(searched)
        robot = None  # From here on it is where it was measured.
    lesson = take_lesson(runs, settings, task=task, robot=robot)
    with training(f"round {rounds}") as report:
        teach(lesson, out=out, report=report, beside=between)
    return runs
