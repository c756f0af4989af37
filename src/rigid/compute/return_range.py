"""The range of adversarialness of a measurement, and where it comes from.

A task may bring its own, frozen range. Where it brings none, or a wrong one for the purpose, the
user gives it as two returns or as a file that `rigid calibrate` measured and froze.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, FiniteFloat, model_validator

from rigid.errors import UserError
from rigid.files import first_difference, read_bytes
from rigid.headers import parse_header
from rigid.tasks.protocol import Task
from rigid.tasks.views.ranged import checked_range

FORMAT = 1
"""Version of the file."""
Source = Literal["task", "option", "calibrated", "provisional"]
"""`range_source` of a measurement: the task's own, two numbers of the user, or a file of `rigid
calibrate`. `provisional` marks the searches of calibrate and doctor on a task without a range: they
look at returns alone."""


@dataclass(frozen=True)
class ReturnRange:
    """Returns (worst, best) that map to adversarialness 1 and 0, and where they come from."""

    worst: float
    best: float
    source: Source
    file: str | None = None
    """Name of the file of a calibrated one."""
    sha256: str | None = None
    """Of its bytes."""

    @property
    def ends(self) -> tuple[float, float]:
        """(worst, best)."""
        return self.worst, self.best

    def describe(self) -> dict[str, Any]:
        """The fields of `frontier.json`."""
        named = None if self.file is None else {"name": self.file, "sha256": self.sha256}
        return {
            "return_range": list(self.ends), "range_source": self.source, "range_file": named,
        }  # fmt: skip


class Returns(BaseModel):
    """How returns of one kind of play are spread."""

    model_config = ConfigDict(extra="allow")

    episodes: int
    mean: FiniteFloat
    se: FiniteFloat | None
    """Standard error of the mean over episodes; None for a single one."""
    quantiles: Mapping[str, FiniteFloat]
    """By the share of episodes below, as `0.05`."""


class RangeFile(BaseModel):
    """What `rigid calibrate` writes; unknown fields are kept, since a newer RIGID may add some."""

    model_config = ConfigDict(extra="allow")

    format: Literal[1]
    kind: Literal["return-range"]
    task: Mapping[str, Any]
    """`Task.describe()`."""
    worst: FiniteFloat
    best: FiniteFloat
    returns: Mapping[str, Returns]
    """By the kind of play: `canonical`, `recorded` (where people were), `sabotage`."""
    provenance: Mapping[str, Any]

    @model_validator(mode="after")
    def _ordered(self) -> RangeFile:
        if not self.worst < self.best:
            raise ValueError(f"worst is {self.worst:g}, which is not below best, {self.best:g}")
        return self


def find_return_range(given: str | Path | Sequence[float] | None, task: Task) -> ReturnRange | None:
    """The range that a user asks for; None leaves the task's own.

    Args:
        given: `"LOW,HIGH"`, a file of `rigid calibrate`, or two returns (worst, best).
        task: Whose range it shall be.

    Raises:
        UserError: It is neither, not increasing, or a file that is damaged or of another task.

    Example:
        >>> from rigid.tasks.registry import make_task
        >>> find_return_range("-100,20", make_task("analytic/hand-tracking")).ends
        (-100.0, 20.0)
    """
    if given is None:
        return None
    if not isinstance(given, str | Path):
        if len(given) != 2:
            raise UserError(f"return_range has {len(given)} numbers, but takes (worst, best)")
        return ReturnRange(*checked_range(given), "option")
    numbers = _numbers(str(given))
    if numbers is not None:
        return ReturnRange(*checked_range(numbers), "option")
    if not Path(given).exists():
        raise UserError(
            f"--return-range {str(given)!r}: give two returns LOW,HIGH, which map to "
            "adversarialness 1 and 0, or a file of `rigid calibrate`; there is no such file"
        )
    return read_range(Path(given), task)


def read_range(path: Path, task: Task) -> ReturnRange:
    """The range that a file of `rigid calibrate` holds.

    Raises:
        UserError: It is missing, damaged, or of another task.
    """
    cure = "measure it again with `rigid calibrate`"
    data = read_bytes(path, cure=cure)
    found = parse_header(RangeFile, data, version=FORMAT, where=path, cure=cure)
    different = first_difference(dict(found.task), dict(task.describe()))
    if different is not None:
        name, there, here = different
        raise UserError(
            f"{path} is the range of another task: {name} is {there!r} there and {here!r} here; "
            "calibrate this task with `rigid calibrate`"
        )
    digest = hashlib.sha256(data).hexdigest()
    return ReturnRange(found.worst, found.best, "calibrated", path.name, digest)


def range_in_force(task: Task, given: ReturnRange | None) -> ReturnRange:
    """The given range, else the task's own.

    Raises:
        UserError: There is neither.
    """
    if given is not None:
        return given
    if task.return_range is None:
        raise UserError(
            f"task {task.name!r} has no range of adversarialness: set its return_range to the "
            "returns (worst, best) that map to 1 and 0, give them with --return-range LOW,HIGH, or "
            "measure them with `rigid calibrate`"
        )
    return ReturnRange(*task.return_range, "task")


def stored_range(data: Mapping[str, Any]) -> ReturnRange:
    """The range of a finished measurement, from its `frontier.json`.

    Raises:
        UserError: It is none.
    """
    try:
        worst, best = checked_range(data["return_range"])
        file = data.get("range_file") or {}
        return ReturnRange(worst, best, data["range_source"], file.get("name"), file.get("sha256"))
    except (KeyError, TypeError, ValueError, AttributeError):
        raise UserError("frontier.json has no range of adversarialness: measure again") from None


def spoken_range(data: Mapping[str, Any]) -> str:
    """The range of a measurement and its source, for people.

    Example:
        >>> spoken_range({"return_range": [-270.0, 450.0], "range_source": "task"})
        "0 at a return of 450, 1 at -270 (the task's range)"
    """
    worst, best = data["return_range"]
    source = data.get("range_source")
    file = data.get("range_file") or {}
    where = {
        "task": "the task's range",
        "option": "a range given by the user",
        "calibrated": f"calibrated range, {file.get('name')} {str(file.get('sha256'))[:8]}",
    }.get(str(source), f"range: {source or 'source unknown'}")
    return f"0 at a return of {best:g}, 1 at {worst:g} ({where})"


def _numbers(text: str) -> tuple[float, float] | None:
    """Two numbers with a comma between; None for any other text."""
    try:
        worst, best = (float(part) for part in text.split(","))
    except ValueError:
        return None
    return (worst, best) if math.isfinite(worst) and math.isfinite(best) else None
