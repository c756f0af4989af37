"""What a study is: one YAML file, checked whole before anybody is invited.

`docs/study.md` explains every field. Paths in the file are relative to it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    NonNegativeInt,
    PositiveInt,
)

from rigid.files import json_text

FORMAT_VERSION = 1

Manner = Literal["own-way", "make-it-fail"]
"""How people are asked to play: 'in your own way', or so that the robot fails (section 5.2)."""
StageKind = Literal["watch", "practise", "play", "judge"]
JudgeQuestion = Literal["correspondence", "danger", "naturalness"]
"""`danger` asks two scales of each member: how well the robot achieves the goal, how much danger it
causes (appendix 'Additional User Study')."""

_Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9-]*$", max_length=40)]
_Key = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9_-]*$", max_length=40)]
_Text = Annotated[str, Field(min_length=1)]


class _Part(BaseModel):
    """Unknown fields are refused: in a file that people write they are typing errors."""

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)


class Consent(_Part):
    """What participants agree to before anything else."""

    version: _Text = "1"
    """Stored with each consent: change it whenever the text changes."""
    text: _Text | None = None
    """The text itself, or a .md or .txt file of it; None: the one that comes with RIGID."""
    sharing: bool = True
    """Whether to ask, separately, if the data may be shared beyond the study."""
    contact: _Text | None = None
    """Whom participants can ask, and where they can withdraw."""


class WatchStage(_Part):
    """Canonical episodes, shown as replays."""

    kind: Literal["watch"] = "watch"
    episodes: PositiveInt = 3
    """Paper, 'VR Visualizations': 3."""


class PractiseStage(_Part):
    """Benign play, 'as in what you watched': the control block of the participant's device."""

    kind: Literal["practise"] = "practise"
    episodes: PositiveInt = 2
    """With each robot. Ours: the paper tells no number."""


class PlayStage(_Part):
    """Episodes that are placed on the frontier's axes."""

    kind: Literal["play"] = "play"
    episodes: PositiveInt = 5
    """With each robot. Ours: the paper tells no number."""
    manner: Manner = "own-way"


class JudgeStage(_Part):
    """A questionnaire about pairs of episodes."""

    kind: Literal["judge"] = "judge"
    question: JudgeQuestion
    pairs: Path
    """From `rigid pairs`; absolute once loaded."""
    show: Literal["snapshot", "replay"] = "replay"
    """A moment of each episode, as in the paper's questionnaire on faithfulness, or its motion."""
    count: PositiveInt = 30
    """Pairs for each participant; the paper shows 30."""
    attention_checks: NonNegativeInt = 0
    """Trials of known answer among them, on top of `count`."""


Stage = Annotated[WatchStage | PractiseStage | PlayStage | JudgeStage, Field(discriminator="kind")]


class Role(_Part):
    """What one kind of participant does, in order; consent and demographics come before."""

    participants: PositiveInt
    """How many are planned."""
    stages: Annotated[tuple[Stage, ...], Field(min_length=1)]
    instructions: Mapping[StageKind, _Text] = Field(default_factory=dict)
    """Replace the text that comes with a kind of stage."""


class Completion(_Part):
    """What a recruiting platform wants to hear at the end."""

    code: _Text | None = None
    url: Annotated[str, Field(pattern=r"^https?://\S+$")] | None = None
    """Where the last page leads."""


class StudyPlan(_Part):
    """The whole file."""

    format: Literal[1] = 1
    title: _Text
    task: _Text = "itch-scratching"
    robots: Annotated[Mapping[_Key, _Text], Field(min_length=1)]
    """Which robots are met, under the keys that the data uses; participants see neither."""
    language: Annotated[str, Field(pattern=r"^[a-z]{2,3}(-[A-Za-z0-9]+)*$")] = "en"
    """Of the page's texts."""
    consent: Consent = Consent()
    demographics: bool = True
    seed: NonNegativeInt = 0
    """Starts of episodes, order and sides come from it."""
    roles: Annotated[Mapping[_Name, Role], Field(min_length=1)]
    completion: Completion | None = None
    paths: Annotated[Mapping[str, str], Field(exclude=True)] = Field(default_factory=dict)
    """What the file calls each absolute path; no field of the file."""


def load_plan(path: Path | str) -> StudyPlan:
    """Reads a study file, or one that comes with RIGID (`builtin:paper-exhaustiveness`).

    Paths of pairs and robots become absolute; the consent's text is read if it names a file.

    Raises:
        UserError: It is missing, no YAML, or says something that it must not; the message names
            each line and field, what is wrong there, and what may stand there.
    """
    from rigid.study.plan_file import read_plan

    return read_plan(path)


def default_plan(task: str, robots: Mapping[str, str]) -> StudyPlan:
    """A study of one role, for `rigid study serve` without a file: novices, as in the paper.

    Args:
        task: As `--task` names it.
        robots: `--robot` specifications by key.
    """
    stages = (WatchStage(), PractiseStage(), PlayStage())
    return StudyPlan(
        title="Playing with an assistive robot",
        task=task,
        robots=robots,
        roles={"novice": Role(participants=8, stages=stages)},
    )


def plan_hash(plan: StudyPlan) -> str:
    """SHA-256 of what the study says: where its folder lies and how it is laid out play no part.

    Pairs and robots count by their names; what they hold is hashed beside (`docs/study.md`).
    """
    return hashlib.sha256(json_text(as_written(plan)).encode()).hexdigest()


def as_written(plan: StudyPlan) -> dict[str, Any]:
    """The plan as JSON, every default spelled out, paths as in its file."""
    document = plan.model_dump(mode="json")
    robots = document["robots"]
    robots.update({key: plan.paths.get(spec, spec) for key, spec in robots.items()})
    for role in document["roles"].values():
        for stage in role["stages"]:
            if "pairs" in stage:
                stage["pairs"] = plan.paths.get(stage["pairs"], stage["pairs"])
    return document
