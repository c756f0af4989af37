"""After a pilot: whether everything is stored that the scripts did, and as it was."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigid.policies.protocol import Policy
from rigid.study.flow import stage_size
from rigid.study.plan import JudgeStage, PlayStage, PractiseStage, StudyPlan
from rigid.study.play.again import states_again
from rigid.study.players import Players
from rigid.study.records import Answer, Participant, PlayedRecord
from rigid.study.store import Store
from rigid.tasks.protocol import Task


@dataclass(frozen=True, kw_only=True)
class Found:
    """What is stored of a scripted participant."""

    participant: Participant
    script: str | None
    """None for those who only judge."""
    practised: int
    played: int
    helped: int
    """Of the played episodes, those that succeeded."""
    unwanted: int
    """Of the played episodes, those in which the robot touched what it should not."""
    trials: int
    passed: int
    """Attention checks."""
    period_ms: float | None
    """95th percentile of the time from step to step, on the study's clock; None without any."""
    problems: tuple[str, ...]


def check_participant(
    plan: StudyPlan, players: Players, store: Store, code: str, failure: str | None
) -> Found:
    """Holds what is stored against what the role asks for.

    Args:
        plan: The study's.
        players: Its task and robots.
        store: Open for reading.
        code: The participant's.
        failure: What ended the script early, if anything did.
    """
    participant = store.participant(code)
    episodes, answers = list(store.episodes(code)), store.answers(code)
    by_kind = {kind: [e for e in episodes if e.kind == kind] for kind in ("practise", "play")}
    problems = [
        *([failure] if failure else []),
        *_of_participant(plan, participant),
        *_of_episodes(plan, participant, by_kind),
        *_of_answers(plan, participant, answers),
        *(text for episode in episodes for text in _of_episode(players, episode)),
    ]
    played = by_kind["play"]
    return Found(
        participant=participant,
        script=next((str(e.about_device.get("script")) for e in episodes), None),
        practised=len(by_kind["practise"]),
        played=len(played),
        helped=sum(e.success == 1 for e in played),
        unwanted=sum(bool((e.arrays.unwanted_force > 0).any()) for e in played),
        trials=len({(answer.stage, answer.trial) for answer in answers}),
        passed=len({(a.stage, a.trial) for a in answers if a.passed}),
        period_ms=_period_ms(episodes),
        problems=tuple(problems),
    )


def plays_again(task: Task, robot: Policy, record: PlayedRecord) -> bool:
    """Whether seed and human actions give the very states that were stored.

    Args:
        task: That was played.
        robot: That was met.
        record: The episode.
    """
    states = states_again(task, robot, record.arrays.human_actions, seed=record.seed)
    return np.array_equal(states, record.arrays.states)


def _of_participant(plan: StudyPlan, participant: Participant) -> Iterator[str]:
    if participant.status != "done":
        yield f"is {participant.status}, not done"
    if participant.kind != "scripted":
        yield f"is stored as a {participant.kind}"
    if participant.consent_version != plan.consent.version:
        yield f"consented to version {participant.consent_version}"


def _of_episodes(
    plan: StudyPlan, participant: Participant, by_kind: Mapping[str, Sequence[PlayedRecord]]
) -> Iterator[str]:
    """Each stage, with every robot."""
    stages = plan.roles[participant.role].stages
    for kind, episodes in by_kind.items():
        each = sum(
            stage.episodes
            for stage in stages
            if isinstance(stage, PractiseStage | PlayStage) and stage.kind == kind
        )
        for robot in plan.robots:
            found = sum(episode.robot == robot for episode in episodes)
            if found != each:
                yield f"has {found} episodes of {kind} with robot {robot}, not {each}"


def _of_episode(players: Players, episode: PlayedRecord) -> Iterator[str]:
    name, arrays = f"{episode.kind} {episode.number}", episode.arrays
    steps = len(arrays.human_actions)
    faulted = bool(arrays.faulted.any())
    if steps != players.task.horizon and not faulted:
        yield f"{name} has {steps} steps, not {players.task.horizon}"
    if episode.device != "scripted":
        yield f"{name} is stored as played by {episode.device}"
    if not np.isfinite(arrays.targets).all():
        yield f"{name} has targets that are not finite"
    if not plays_again(players.task, players.robots[episode.robot], episode):
        yield f"{name} does not come out again from its seed and actions"


def _of_answers(
    plan: StudyPlan, participant: Participant, answers: Sequence[Answer]
) -> Iterator[str]:
    for index, stage in enumerate(plan.roles[participant.role].stages):
        if isinstance(stage, JudgeStage):
            found = len({answer.trial for answer in answers if answer.stage == index})
            asked = stage_size(plan, stage)
            if found != asked:
                yield f"answered {found} trials about {stage.question}, not {asked}"


def _period_ms(episodes: Sequence[PlayedRecord]) -> float | None:
    periods = [np.diff(episode.arrays.step_times) for episode in episodes]
    return 1000 * float(np.percentile(np.concatenate(periods), 95)) if periods else None
