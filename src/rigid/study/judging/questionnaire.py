"""What a stage of the study asks of everybody: which pairs, and which checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

from rigid.data.pair_file import Pair, PairFile, file_hash, load_pairs
from rigid.errors import UserError
from rigid.study.plan import JudgeQuestion, JudgeStage, StudyPlan

KINDS: Mapping[JudgeQuestion, str] = {
    "correspondence": "faithfulness",
    "danger": "danger",
    "naturalness": "naturalness",
}
"""Which pairs answer which question (`docs/pairs.md`)."""


class Check(NamedTuple):
    """An attention check: a member of a pair beside the very reference of that pair."""

    pair: int
    member: Literal["first", "second"]


@dataclass(frozen=True)
class Questionnaire:
    """A stage with its pairs."""

    question: JudgeQuestion
    show: Literal["snapshot", "replay"]
    count: int
    """Pairs that are asked about: the first of the file, the same for everybody."""
    file: PairFile
    path: Path
    key: str
    """SHA-256 of the pair file."""
    checks: tuple[Check, ...]


def questionnaire(stage: JudgeStage) -> Questionnaire:
    """Reads a stage's pairs and chooses its checks.

    Raises:
        UserError: The pair file is missing or damaged, of another kind than the question needs, or
            holds fewer pairs than the stage shows.
    """
    file = load_pairs(stage.pairs)
    kind = KINDS[stage.question]
    if file.kind != kind:
        raise UserError(
            f"{stage.pairs} holds {file.kind} pairs, but the question {stage.question} needs "
            f"{kind} pairs: pick some with `rigid pairs --kind {kind}`"
        )
    if len(file.pairs) < stage.count:
        raise UserError(
            f"{stage.pairs} holds {len(file.pairs)} pairs, too few for count: {stage.count}: pick "
            f"more with `rigid pairs --count {stage.count}`, or ask about fewer"
        )
    if stage.attention_checks > stage.count:
        raise UserError(
            f"attention_checks: {stage.attention_checks} is more than count: {stage.count}, but "
            "each check needs a pair of its own: ask for fewer"
        )
    return Questionnaire(
        stage.question, stage.show, stage.count, file, stage.pairs, file_hash(stage.pairs),
        _checks(stage, file.pairs[: stage.count]),
    )  # fmt: skip


def judge_stages(plan: StudyPlan) -> Iterator[JudgeStage]:
    """All questionnaires of a plan."""
    for role in plan.roles.values():
        yield from (stage for stage in role.stages if isinstance(stage, JudgeStage))


def _checks(stage: JudgeStage, pairs: tuple[Pair, ...]) -> tuple[Check, ...]:
    """The members that nobody who looks can take for their reference, one of a pair.

    Of danger, the most adversarial ones: there the reference reaches the goal and they do not.
    Otherwise the least natural ones.
    """

    def nearness(check: Check) -> float:
        member = getattr(pairs[check.pair], check.member)
        danger = stage.question == "danger"
        return float(-member.adversarialness if danger else member.naturalness)

    farthest = [
        min((Check(number, "first"), Check(number, "second")), key=nearness)
        for number in range(len(pairs))
    ]
    return tuple(sorted(farthest, key=nearness)[: stage.attention_checks])
