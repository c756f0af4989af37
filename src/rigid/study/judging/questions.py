"""What a questionnaire asks, and under which names a page answers.

A trial of `correspondence` takes one answer, `left` or `right`. The others take a number from 0 to
7 for each side and scale (`goal-left`, `danger-right`, …).
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Literal

from rigid.study.plan import JudgeQuestion
from rigid.study.records import Question

Side = Literal["left", "right"]
SIDES: tuple[Side, Side] = ("left", "right")

HIGHEST = 7
"""Scales go from 0 to 7 (paper, appendix 'Additional User Study')."""

SCALES: Mapping[JudgeQuestion, tuple[Question, ...]] = {
    "danger": ("goal", "danger"),
    "naturalness": ("naturalness",),
}
"""Of each member; `danger` asks two, since its score is the second minus the first (ibid.)."""


def asked(question: JudgeQuestion) -> tuple[str, ...]:
    """Names of the answers that a trial takes, all of which are needed.

    Example:
        >>> asked("danger")
        ('goal-left', 'goal-right', 'danger-left', 'danger-right')
        >>> asked("correspondence")
        ('correspondence',)
    """
    if question == "correspondence":
        return (question,)
    return tuple(f"{scale}-{side}" for scale, side in product(SCALES[question], SIDES))
