"""The option by which a command is told the range of adversarialness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import tyro


@dataclass(frozen=True, kw_only=True)
class RangeOptions:
    """What 0 and 1 stand for on the y axis."""

    return_range: Annotated[str | None, tyro.conf.arg(metavar="LOW,HIGH|FILE")] = None
    """Returns for adversarialness 1 and 0, or a file of rigid calibrate."""
