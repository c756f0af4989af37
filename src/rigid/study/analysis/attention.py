"""Trials of known answer: who failed one, and the answers without theirs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from rigid.study.records import Answer


class Attention(NamedTuple):
    """How one rater did in the attention checks."""

    participant: str
    asked: int
    failed: int


def attention(answers: Sequence[Answer]) -> list[Attention]:
    """Every rater who was checked, in the order of their codes.

    A trial that asks several scales is one check, failed where one of its answers is.
    """
    checks: dict[str, dict[tuple[int, str], bool]] = {}
    for answer in answers:
        if answer.passed is None:
            continue
        trial = (answer.stage, answer.trial)
        mine = checks.setdefault(answer.participant, {})
        mine[trial] = mine.get(trial, True) and answer.passed
    return [
        Attention(code, len(passed), sum(not right for right in passed.values()))
        for code, passed in sorted(checks.items())
    ]


def who_failed(checks: Sequence[Attention]) -> frozenset[str]:
    """Raters who failed one check or more."""
    return frozenset(check.participant for check in checks if check.failed)
