"""Names of the motions that a questionnaire shows."""

from __future__ import annotations

from typing import Literal, NamedTuple

from rigid.study.judging.questionnaire import Questionnaire

Place = Literal["first", "second"]
"""Of a member in its pair."""
Who = Literal["first", "second", "reference"]


class ClipName(NamedTuple):
    """A motion of a pair file, or a moment of one."""

    file: str
    """Hash of the pair file."""
    pair: int
    who: Who
    moment: int | None
    """Control steps since the start; None for the whole motion."""


def clip_of(asks: Questionnaire, pair: int, who: Who) -> ClipName:
    """What stands for a member or the reference of a pair: references always move."""
    found = asks.file.pairs[pair]
    member = found.first if who == "first" else found.second
    still = asks.show == "snapshot" and who != "reference"
    return ClipName(asks.key, pair, who, member.snapshot if still else None)
