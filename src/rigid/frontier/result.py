"""The result of a measurement: `frontier.json` as an object."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.frontier.statistics import MeasuredPoint

FILE = "frontier.json"
_CARD = "policy.json"
"""What marks the directory of a policy: `rigid.policies.native.CARD_FILE`, whose module needs JAX,
and so more time than the whole of a message."""


@dataclass(frozen=True)
class Frontier:
    """The natural-adversarial frontier of one robot.

    Every number is an estimate at the stated search power: a weak referee errs upwards, a weak
    search downwards; it bounds nothing.
    """

    directory: Path
    data: Mapping[str, Any]
    """`frontier.json`, schema 1."""

    @property
    def points(self) -> list[dict[str, Any]]:
        """The adversaries found, each a dict as in `frontier.json`."""
        return list(self.data["points"])

    @property
    def worst_at(self) -> dict[str, float]:
        """Worst adversarialness found at naturalness of at least "0.8", "0.9", "0.95"."""
        return dict(self.data["worst_at"])

    @property
    def auc_natural(self) -> float:
        """Mean height of the hull over naturalness in [0.8, 1]."""
        return float(self.data["auc_natural"])

    @property
    def auc(self) -> float:
        """Area under the hull, mean over seeds; lower is more robust."""
        return float(self.data["auc"])

    @property
    def auc_interval(self) -> tuple[float, float] | None:
        """95 % t interval of `auc` over search seeds; None for one seed."""
        interval = self.data["auc_interval"]
        return None if interval is None else (float(interval[0]), float(interval[1]))

    def seeds_at(self, level: float) -> tuple[int, int]:
        """How many search seeds found a human of at least this naturalness, and of how many."""
        found = {
            point.seed for point in measured_points(self.points)
            if point.is_sound and point.naturalness >= level
        }  # fmt: skip
        return len(found), len(self.data["auc_by_seed"])

    def lacking_at(self, level: float) -> str | None:
        """Says that `worst_at` rests on canonical play in some seeds; None where it does not."""
        return lacking(*self.seeds_at(level), level)

    def report(self, path: Path | str | None = None) -> Path:
        """Writes the self-contained HTML report and returns its path."""
        from rigid.report.gather import write_report

        return write_report(self.directory, None if path is None else Path(path))


def lacking(found: int, searches: int, level: float, *, called: str = "seeds") -> str | None:
    """Says that canonical play stands where searches found no natural human; None where all did.

    Args:
        found: Searches that found one.
        searches: Searches in all.
        level: Least naturalness.
        called: What they are: seeds of one robot, or searches of several.

    Example:
        >>> lacking(2, 6, 0.9)
        '2 of 6 seeds found a human at naturalness ≥ 0.9; in the others canonical play stands there'
    """
    if found == searches:
        return None
    if searches == 1:
        return f"the seed found no human at naturalness ≥ {level:g}: canonical play stands there"
    others = "other" if searches - found == 1 else "others"
    none = ": in both" if searches == 2 else ": in all of them"
    where = f"; in the {others}" if found else none
    return (
        f"{found} of {searches} {called} found a human at naturalness ≥ {level:g}{where} canonical "
        "play stands there"
    )


def load_frontier(directory: Path | str) -> Frontier:
    """Reads a finished run directory.

    Raises:
        UserError: There is no finished measurement, or its file is damaged.
    """
    folder = Path(directory)
    if not folder.is_dir():
        raise UserError(f"there is no directory {folder}: name a run of `rigid frontier`")
    path = folder / FILE
    if not path.exists():
        _refuse_what_is_no_run(folder)
    cure = "run `rigid frontier` with this --out to finish it"
    # The file that is there would make that command call the measurement complete.
    again = f"delete it and {cure}; what is trained is kept"
    try:
        data = json.loads(read_bytes(path, cure=cure))
    except ValueError:
        raise UserError(f"{path} is damaged: {again}") from None
    wrong = _first_fault(data)
    if wrong is not None:
        raise UserError(f"{path} is not a frontier of schema 1 ({wrong}): {again}")
    return Frontier(folder, data)


def _refuse_what_is_no_run(folder: Path) -> None:
    """Says what a directory without a result is, where it is no measurement to be finished."""
    from rigid.compute.run.directory import RunDirectory, is_being_measured

    if is_being_measured(folder):
        raise UserError(f"{folder} is being measured right now: wait for it")
    if not (folder / _CARD).exists() or RunDirectory(folder).settings.exists():
        return
    if _agent_of(folder / _CARD) == "human":
        raise UserError(
            f"{folder} is the policy of a human ({_CARD}), not a measurement: measure a robot with "
            f"it, `rigid frontier --robot ROBOT --human {folder} --out NEW`, then name NEW"
        )
    raise UserError(
        f"{folder} is a policy ({_CARD}), not a measurement: measure it, "
        f"`rigid frontier --robot {folder} --out NEW`, then name NEW"
    )


def _agent_of(card: Path) -> object:
    try:
        return json.loads(card.read_bytes())["agent"]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _first_fault(data: object) -> str | None:
    """Where `data` departs from the schema, None where it does not."""
    from pydantic import ValidationError  # Here, since it takes longer than all the rest.

    from rigid.frontier.schema import FrontierFile

    try:
        FrontierFile.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        return f"{'.'.join(str(part) for part in first['loc'])}: {first['msg']}"
    return None


def measured_points(points: Sequence[Mapping[str, Any]]) -> list[MeasuredPoint]:
    """Entries of `frontier.json`'s points as the statistics take them; null becomes NaN."""
    return [
        MeasuredPoint(
            id=point["id"],
            seed=point["seed"],
            naturalness=point["naturalness"],
            naturalness_own=point["naturalness_own"],
            adversarialness=math.nan if (y := point["adversarialness"]) is None else y,
            faulted_share=point["faults"] / point["episodes"],
        )
        for point in points
    ]
