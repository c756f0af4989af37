"""The whole analysis of a study, from what was read to everything that is told."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

from rigid.study.analysis.counting import Control, Count, controls_of, counts_of
from rigid.study.analysis.judged import Asked
from rigid.study.analysis.judgements import Judged, judge
from rigid.study.analysis.placing import Placed, place
from rigid.study.analysis.players import players_of
from rigid.study.analysis.reading import MeasuredRobot, Questionnaire, StudyData
from rigid.study.analysis.robots import RobotOrder, robot_order
from rigid.study.analysis.settings import AnalysisSettings, analysis_hash
from rigid.study.records import Answer, Kind

Say = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Analysis:
    """What a study says."""

    title: str
    task: str
    robots: Mapping[str, MeasuredRobot]
    unmeasured: tuple[str, ...]
    """Robots that somebody met and of which no run was named."""
    placed: tuple[Placed, ...]
    controls: tuple[Control, ...]
    counts: tuple[Count, ...]
    judged: tuple[Judged, ...]
    order: RobotOrder | None
    people: Mapping[str, int]
    """How many persons of each role consented."""
    scripted: int
    """How many participants were scripts."""
    withdrawn: int
    registered: bool | None
    """Whether the analysis is the one that was registered; None where none was."""
    settings: AnalysisSettings

    @property
    def met(self) -> tuple[str, ...]:
        """Robots that were measured and that somebody met, scripts included."""
        return tuple(k for k in self.robots if any(p.player.robot == k for p in self.placed))


def analyse(
    study: StudyData,
    robots: Mapping[str, MeasuredRobot],
    questionnaires: Sequence[Questionnaire],
    settings: AnalysisSettings,
    *,
    say: Say = lambda _: None,
) -> Analysis:
    """Analyses a study.

    Args:
        study: What was collected.
        robots: The robots that were measured, by their keys.
        questionnaires: With their pairs.
        settings: What is fixed beforehand.
        say: Told of progress.
    """
    players = players_of(study.episodes, study.participants)
    met = {player.robot for player in players}
    placed: list[Placed] = []
    controls: list[Control] = []
    counts: list[Count] = []
    for key, robot in robots.items():
        mine = [player for player in players if player.robot == key]
        say(f"robot {key}: placing {len(mine)} players by {len(robot.panels)} referees")
        found, control = place(robot, mine), controls_of(robot, mine, settings)
        placed += found
        controls += control.values()
        counts += counts_of(key, found, control)
    took_part = [p for p in study.participants.values() if p.status != "invited"]
    roles = [p.role for p in took_part if p.kind == "person"]
    return Analysis(
        title=study.plan.title, task=study.plan.task, robots=robots,
        unmeasured=tuple(key for key in study.plan.robots if key in met and key not in robots),
        placed=tuple(placed), controls=tuple(controls), counts=tuple(counts),
        judged=_judged(study, questionnaires, settings, say),
        order=robot_order(robots, placed, settings),
        people={role: roles.count(role) for role in dict.fromkeys(roles)},
        scripted=sum(p.kind == "scripted" for p in took_part),
        withdrawn=study.withdrawn, settings=settings, registered=_registered(study, settings),
    )  # fmt: skip


def _judged(
    study: StudyData,
    questionnaires: Sequence[Questionnaire],
    settings: AnalysisSettings,
    say: Say,
) -> tuple[Judged, ...]:
    """Every questionnaire; roles that judged the same pairs are one."""
    together: dict[tuple[str, str], list[Questionnaire]] = {}
    for one in questionnaires:
        together.setdefault((one.question, one.name), []).append(one)
    found = []
    for (question, name), same in together.items():
        answers = [a for a in study.answers if _belongs(a, same, study)]
        people = [a for a in answers if study.participants[a.participant].kind == "person"]
        of: Kind = "person" if people else "scripted"
        pairs = same[0].pairs.pairs
        asked = cast("Asked", question)
        judged = judge(asked, name, people or answers, pairs, settings, of=of, say=say)
        if judged is not None:
            found.append(judged)
    return tuple(found)


def _belongs(answer: Answer, same: Sequence[Questionnaire], study: StudyData) -> bool:
    role = study.participants[answer.participant].role
    return any((role, answer.stage) == (one.role, one.stage) for one in same)


def _registered(study: StudyData, settings: AnalysisSettings) -> bool | None:
    known: Any = study.registered.get("analysis")
    return None if known is None else known == analysis_hash(settings)
