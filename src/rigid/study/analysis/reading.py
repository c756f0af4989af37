"""What an analysis reads: a study's store, the runs that measured its robots, its pair files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rigid.compute.pairs.members import MeasuredRun, read_run
from rigid.compute.people.recorded import stored_panels
from rigid.compute.run.checkpoint import load_arrays
from rigid.compute.run.directory import RunDirectory
from rigid.data.pair_file import PairFile, file_hash, load_pairs
from rigid.errors import UserError
from rigid.files import first_difference
from rigid.frontier.result import Frontier, measured_points
from rigid.naturalness.features import DEFAULT, Features, choose_features
from rigid.naturalness.panel import Panel
from rigid.study.analysis.dominance import Frontage
from rigid.study.plan import JudgeStage, StudyPlan
from rigid.study.records import Answer, Participant, PlayedRecord
from rigid.study.store.store import Store
from rigid.tasks.protocol import Task, adversarialness

_CURE = "copy the run directory again, or measure again"
_LAW = ("robot", "human", "canonical", "features", "task")
"""What must be equal for referees of several runs to speak of one canonical law."""


class StudyData(NamedTuple):
    """Everything that a study collected, but for those who withdrew."""

    plan: StudyPlan
    registered: Mapping[str, str]
    """Hashes that were fixed before the first participant; see `rigid.study.registration`."""
    participants: Mapping[str, Participant]
    """By code."""
    episodes: tuple[PlayedRecord, ...]
    answers: tuple[Answer, ...]
    withdrawn: int


@dataclass(frozen=True)
class MeasuredRobot:
    """A robot of the study with what runs found of it."""

    key: str
    """In the study's file."""
    runs: tuple[MeasuredRun, ...]
    """Several runs of one robot make one frontier."""
    panels: tuple[Panel, ...]
    names: tuple[str, ...]
    """Of the adversary that each panel was trained for."""
    front: Frontage
    features: Features
    """What the referees see."""

    @property
    def frontiers(self) -> list[Frontier]:
        """One for each run."""
        return [run.frontier for run in self.runs]

    @property
    def task(self) -> Task:
        """The runs'."""
        return self.runs[0].task

    @property
    def return_range(self) -> tuple[float, float]:
        """Returns that map to adversarialness 1 and 0."""
        return self.runs[0].return_range


class Questionnaire(NamedTuple):
    """A questionnaire of one role, with its pairs."""

    role: str
    stage: int
    question: str
    name: str
    """Of the pair file."""
    pairs: PairFile


def read_study(data: Path) -> StudyData:
    """Reads a study's store, which may be in use.

    Raises:
        UserError: There is none in `data`, or it names no study.
    """
    with Store.read(data) as store, store.snapshot():
        plan = store.plan()
        if plan is None:
            raise UserError(f"{data} holds no study yet: collect one with `rigid study serve`")
        return StudyData(
            plan=plan,
            registered=dict(store.registered()),
            participants={person.code: person for person in store.participants()},
            episodes=tuple(store.episodes()),
            answers=tuple(store.answers()),
            withdrawn=len(store.withdrawn()),
        )


def read_robots(
    named: Sequence[str], study: StudyData, *, quantile: float
) -> dict[str, MeasuredRobot]:
    """The runs of the study's robots, by the robots' keys in the order of the plan.

    Args:
        named: Run directories, as DIR or KEY=DIR. A plain one goes to the robot whose hash it has.
        study: With the hashes of its robots, if they were registered.
        quantile: Of an adversary's episodes, for `Frontage.of_episodes`.

    Raises:
        UserError: A directory is no finished run, or none of a robot of this study.
    """
    found: dict[str, list[MeasuredRun]] = {}
    for text in named:
        key, run = _assigned(text, study)
        found.setdefault(key, []).append(run)
    return {
        key: _measured(key, found[key], quantile=quantile)
        for key in study.plan.robots if key in found
    }  # fmt: skip


def read_questionnaires(plan: StudyPlan, registered: Mapping[str, str]) -> list[Questionnaire]:
    """Every questionnaire of the study with its pairs.

    Raises:
        UserError: A pair file is missing, damaged, or not the one that was registered.
    """
    known = {value for name, value in registered.items() if name.startswith("pairs/")}
    found = []
    for role, place, stage in _judging(plan):
        path = Path(stage.pairs)
        if known and file_hash(path) not in known:
            raise UserError(
                f"{path} is not the pair file that the study was registered with, so nobody knows "
                "what was judged: put the old one back"
            )
        found.append(Questionnaire(role, place, stage.question, path.name, load_pairs(path)))
    return found


def _judging(plan: StudyPlan) -> Iterator[tuple[str, int, JudgeStage]]:
    for role, described in plan.roles.items():
        for place, stage in enumerate(described.stages):
            if isinstance(stage, JudgeStage):
                yield role, place, stage


def _assigned(text: str, study: StudyData) -> tuple[str, MeasuredRun]:
    """A run and the key of the robot that it measured."""
    key, named, path = text.partition("=")
    if named and key in study.plan.robots:
        run = read_run(Path(path))
        registered = study.registered.get(f"robots/{key}")
        if registered is not None and registered != run.identity["robot"]:
            raise UserError(
                f"{path} measured another robot than {key!r} of the study was: name its own run"
            )
        return key, run
    run = read_run(Path(text))
    keys = [key for key in study.plan.robots if _is_of(run, key, study)]
    if len(keys) != 1:
        robots = ", ".join(f"{key} ({spec})" for key, spec in study.plan.robots.items())
        raise UserError(
            f"{text} measured {run.frontier.data['robot']}, which is "
            f"{'several robots' if keys else 'no robot'} of this study ({robots}): name the runs "
            f"of its robots, or say which robot it is as KEY={text}"
        )
    return keys[0], run


def _is_of(run: MeasuredRun, key: str, study: StudyData) -> bool:
    """Whether a run measured a robot of the study; by its name where no hash was registered."""
    registered = study.registered.get(f"robots/{key}")
    if registered is not None:
        return bool(registered == run.identity["robot"])
    spec, measured = study.plan.robots[key], str(run.frontier.data["robot"])
    return spec == measured or Path(spec).absolute() == Path(measured).absolute()


def _measured(key: str, runs: Sequence[MeasuredRun], *, quantile: float) -> MeasuredRobot:
    first = runs[0]
    for other in runs[1:]:
        _check_one_law(first, other)
    names = [(run, point["id"]) for run in runs for point in run.frontier.points]
    panels = [p for run in runs for p in stored_panels(run.directory, _ids(run))]
    return MeasuredRobot(
        key=key,
        runs=tuple(runs),
        panels=tuple(panels),
        names=tuple(f"{run.directory.name}/{point}" for run, point in names),
        front=_frontage(runs, quantile),
        features=choose_features(str(first.identity.get("features", DEFAULT)), first.task),
    )


def _ids(run: MeasuredRun) -> list[str]:
    return [point["id"] for point in run.frontier.points]


def _check_one_law(one: MeasuredRun, other: MeasuredRun) -> None:
    """Refuses runs of one robot whose axes are not the same."""
    both = [
        {**{name: run.identity.get(name) for name in _LAW}, "range": run.return_range}
        for run in (one, other)
    ]
    different = first_difference(*both)
    if different is not None:
        raise UserError(
            f"{one.directory} and {other.directory} are not of one measure ({different[0]} "
            "differs), so they are no frontier together: name one of them"
        )


def _frontage(runs: Sequence[MeasuredRun], quantile: float) -> Frontage:
    """The adversaries that count, and canonical play, with quantiles of their episodes."""
    rows: list[tuple[float, float, float]] = []
    for run in runs:
        canonical: dict[int, float] = {}
        points = run.frontier.points
        for point, measured in zip(points, measured_points(points), strict=True):
            if not measured.is_sound:
                continue
            arrays = _kept(run, str(point["id"]))
            sound = arrays["faulted"] == 0
            harm = adversarialness(arrays["returns"][sound], run.return_range)
            height = float(np.quantile(harm, quantile))
            rows.append((measured.naturalness, measured.adversarialness, height))
            seeds = arrays["seeds"][arrays["shown"]].tolist()
            canonical |= dict(zip(seeds, arrays["canonical_returns"].tolist(), strict=True))
        # Canonical play of as many starts as the run kept; its mean is that of many more.
        anchor = float(run.frontier.data["canonical"]["adversarialness"])
        harm = adversarialness(np.array(list(canonical.values()) or [np.nan]), run.return_range)
        height = anchor if np.isnan(harm).any() else float(np.quantile(harm, quantile))
        rows.append((1.0, anchor, max(height, anchor)))
    x, y, q = np.array(rows, dtype=float).T
    return Frontage(x, y, q)


def _kept(run: MeasuredRun, point: str) -> dict[str, np.ndarray]:
    """What a run keeps of the episodes of an adversary."""
    path = RunDirectory(run.directory).adversary(point) / "episodes.npz"
    arrays = load_arrays(path, cure=_CURE)
    for name in ("seeds", "returns", "faulted", "shown", "canonical_returns"):
        if name not in arrays:
            raise UserError(f"{path} is damaged (it has no {name!r}): {_CURE}")
    return arrays
