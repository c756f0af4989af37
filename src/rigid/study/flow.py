"""What comes next for a participant: a pure function of the plan and of what is stored.

So a page that is reloaded, a dropped connection and a server that starts again all go on where the
participant was.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from rigid.study.plan import (
    JudgeStage,
    PlayStage,
    PractiseStage,
    Stage,
    StudyPlan,
    WatchStage,
)
from rigid.study.records import EpisodeKind, Participant
from rigid.study.store.shapes import Standing
from rigid.study.store.store import Store

PositionKind = Literal[
    "consent", "demographics", "watch", "practise", "play", "judge", "done", "stopped"
]
_KINDS: tuple[EpisodeKind, ...] = ("practise", "play")


class NextEpisode(NamedTuple):
    """The episode that a participant plays next."""

    kind: EpisodeKind
    number: int
    """Place among the participant's episodes of this kind, from 0."""
    robot: str
    """Key of the robot in the study's file."""
    seed: int


@dataclass(frozen=True)
class Position:
    """Where a participant stands."""

    kind: PositionKind
    index: int | None
    """Place in the role's stages; None before and after them."""
    done: int
    """Episodes or trials of this stage that are stored."""
    of: int
    """Episodes (with all robots together) or trials of this stage; 0 where it has none."""
    episode: NextEpisode | None
    """In practise and play."""
    finished: frozenset[str]
    """In watch and judge: ids of the episodes watched, of the trials answered."""


def position(plan: StudyPlan, store: Store, participant: Participant) -> Position:
    """Where a participant stands.

    Raises:
        GoneError: They withdrew.
        KeyError: The plan lacks their role.
    """
    return next_position(plan, store.standing(participant.code))


def next_position(plan: StudyPlan, standing: Standing) -> Position:
    """As `position`, of what is stored alone."""
    who = standing.participant
    if who.status == "stopped":
        return _between("stopped")
    if who.status == "done":
        return _between("done")
    if who.consent_version != plan.consent.version:
        return _between("consent")
    if plan.demographics and not standing.demographics_given:
        return _between("demographics")
    stages = plan.roles[who.role].stages
    for index, stage in enumerate(stages):
        finished = _finished(stage, index, standing)
        done = standing.played.get(index, 0) if _is_played(stage) else len(finished)
        of = stage_size(plan, stage)
        if done < of:
            episode = _next_episode(plan, who, stages, index, done) if _is_played(stage) else None
            return Position(stage.kind, index, done, of, episode, finished)
    return _between("done")


def stage_size(plan: StudyPlan, stage: Stage) -> int:
    """How many episodes (those with each robot) or trials (checks too) a stage has."""
    match stage:
        case WatchStage():
            return stage.episodes
        case PractiseStage() | PlayStage():
            return stage.episodes * len(plan.robots)
        case JudgeStage():
            return stage.count + stage.attention_checks


def robot_order(robots: Sequence[str], place: int) -> tuple[str, ...]:
    """In which order a participant meets the robots.

    Rows of a Williams square (1949, two squares for an odd number): over as many participants as
    the square has rows, each robot comes equally often at each place and after each other one.

    Args:
        robots: Their keys.
        place: Of the participant among those of the role.

    Example:
        >>> robot_order("ab", 0), robot_order("ab", 1)
        (('a', 'b'), ('b', 'a'))
    """
    count = len(robots)
    zigzag = [(i + 1) // 2 if i % 2 else -(i // 2) for i in range(count)]
    square, row = divmod(place % (count * (1 + count % 2)), count)
    order = tuple(robots[(shift + row) % count] for shift in zigzag)
    return order[::-1] if square else order


def episode_seed(plan: StudyPlan, code: str, kind: EpisodeKind, start: int) -> int:
    """The seed of an episode's start; below 2³², so that it is exact in every table.

    Args:
        plan: Its seed counts.
        code: The participant's, such as P07.
        kind: Practice and play start elsewhere.
        start: Which of the starts of this kind: a participant meets each with every robot, since
            robots are told apart best where all else is the same.
    """
    letter, number = ord(code[0]), int(code[1:])
    words = (plan.seed, letter, number, _KINDS.index(kind), start)
    return int(np.random.SeedSequence(words).generate_state(1)[0])


def _between(kind: PositionKind) -> Position:
    return Position(kind, None, 0, 0, None, frozenset())


def _is_played(stage: Stage) -> bool:
    return isinstance(stage, PractiseStage | PlayStage)


def _finished(stage: Stage, index: int, standing: Standing) -> frozenset[str]:
    found = {"watch": standing.watched, "judge": standing.answered}.get(stage.kind, {})
    return found.get(index, frozenset())


def _next_episode(
    plan: StudyPlan, who: Participant, stages: Sequence[Stage], index: int, done: int
) -> NextEpisode:
    """One robot after the other, each with the same starts."""
    stage = stages[index]
    assert isinstance(stage, PractiseStage | PlayStage)
    earlier = [s for s in stages[:index] if isinstance(s, type(stage))]
    met, episode = divmod(done, stage.episodes)
    robot = robot_order(tuple(sorted(plan.robots)), who.place or 0)[met]
    start = sum(s.episodes for s in earlier) + episode
    number = sum(stage_size(plan, s) for s in earlier) + done
    return NextEpisode(stage.kind, number, robot, episode_seed(plan, who.code, stage.kind, start))
