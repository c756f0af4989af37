"""From kept parts to the rows of the table: a value and a difference to the reference each."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from benchmarks.physics.intervals import Estimate, mean, relative, share, share_difference
from benchmarks.physics.plan import (
    AGED,
    DEFAULT,
    FINEST,
    PAIRS,
    SETTINGS,
    SPEEDS,
    SWINGS,
    WINDOW_REFERENCE,
    Plan,
    Setting,
)
from benchmarks.physics.windows import canonical_ruler

Row = dict[str, Any]
Parts = Mapping[str, Any]
"""Every kept part by its name, see `part_name`."""

_COLUMNS = ("value", "low", "high", "difference", "difference_low", "difference_high")
_ABSOLUTE = ("return", "counted", "penetration")
AGED_NUMBERS = ("return", "success", "counted")
"""What old poses may change."""
_RELATIVE = ("peak_force", "impulse")


def part_name(*words: object) -> str:
    """Under which a part is kept.

    Example:
        >>> part_name("closed", "loud", Setting(0.02))
        'closed-loud-0.02'
    """
    return "-".join(f"{one.step:g}" if isinstance(one, Setting) else str(one) for one in words)


def table(parts: Parts, plan: Plan) -> list[Row]:
    """All rows of all parts."""
    rows: list[Row] = []
    for pair in PAIRS:
        rows += closed_rows(pair, {one: parts[part_name("closed", pair, one)] for one in SETTINGS})
    for pair in AGED:
        coarse, fine = (parts[part_name("closed", pair, one)] for one in (DEFAULT, FINEST))
        rows += aged_rows(pair, coarse, parts[part_name("aged", pair)], fine)
    for pair in PAIRS:
        rows += window_rows(pair, parts[part_name("windows", pair)])
    for swing in SWINGS:
        rows += energy_rows(swing, parts[part_name("energy", swing)])
    ratios = parts["cost"]
    rows += [
        _row("cost", "canonical", one, "cost", plan.turns, mean(np.array(ratios[one.name])))
        for one in SETTINGS
    ]
    return rows


def closed_rows(pair: str, played: Mapping[Setting, Mapping[str, Any]]) -> list[Row]:
    """Episodes with policies that act, against the same episodes at the finest step.

    Episodes that ran away count in `faulted` alone, and their twins with them.
    """
    columns = {setting: _arrays(numbers) for setting, numbers in played.items()}
    reference = columns[FINEST]
    rows = []
    for setting, mine in columns.items():
        sound = (mine["faulted"] == 0) & (reference["faulted"] == 0)
        against = None if setting == FINEST else reference
        rows += _closed(pair, setting, mine, against, sound)
    return rows


def _closed(
    pair: str,
    setting: Setting,
    mine: Mapping[str, np.ndarray],
    reference: Mapping[str, np.ndarray] | None,
    sound: Bool[np.ndarray, " n"],
) -> list[Row]:
    def row(number: str, value: Estimate | float, difference: Estimate | None = None) -> Row:
        return _row("closed", pair, setting, number, int(sound.sum()), value, difference)

    def compared(name: str, value: Any, difference: Any) -> Row:
        found = None if reference is None else difference(mine[name][sound], reference[name][sound])
        return row(name, value(mine[name][sound]), found)

    rows = [
        *(compared(name, mean, lambda x, y: mean(x - y)) for name in _ABSOLUTE),
        compared("success", share, share_difference),
        *(compared(name, mean, relative) for name in _RELATIVE),
        row("deepest", float(mine["penetration"][sound].max())),
        row("fastest", float(mine["fastest"][sound].max())),
        _row("closed", pair, setting, "faulted", len(sound), share(mine["faulted"])),
    ]
    if reference is not None:
        deviations, _ = canonical_ruler()
        apart = np.abs(mine["angles"] - reference["angles"])[sound] / deviations
        rows.append(row("angles", mean(apart.mean(axis=1))))
    return rows


def aged_rows(
    pair: str, coarse: Mapping[str, Any], aged: Mapping[str, Any], fine: Mapping[str, Any]
) -> list[Row]:
    """A difference of steps in two: old poses at the finest step, and all the rest.

    Args:
        pair: Name of the human.
        coarse: Episodes at the task's step.
        aged: The same at the finest step with poses as old as there.
        fine: The same at the finest step.
    """
    played = [_arrays(one) for one in (coarse, aged, fine)]
    sound = np.all([one["faulted"] == 0 for one in played], axis=0)
    rows = []
    for setting, (mine, reference) in zip((DEFAULT, FINEST), pairwise(played), strict=True):
        for name in AGED_NUMBERS:
            x, y = mine[name][sound], reference[name][sound]
            difference = share_difference(x, y) if name == "success" else mean(x - y)
            value = share(x) if name == "success" else mean(x)
            rows.append(_row("aged", pair, setting, name, int(sound.sum()), value, difference))
    return rows


def energy_rows(swing: str, part: Mapping[str, Mapping[str, list[float]]]) -> list[Row]:
    """Swings of one kind: mean gain of energy, and the worst swing's."""
    rows = []
    for speed in SPEEDS:
        for one in SETTINGS:
            growth = np.array(part[f"{speed:g}"][one.name])
            case = f"{swing}, {speed:g} rad/s"
            rows.append(_row("energy", case, one, "growth", len(growth), mean(growth)))
            rows.append(_row("energy", case, one, "worst", len(growth), float(growth.max())))
    return rows


def window_rows(pair: str, part: Mapping[str, Any]) -> list[Row]:
    """Half seconds with recorded targets, against the same at the finest step of all.

    Forces and overlaps are those of windows with touch, as means over these; episodes without
    one tell nothing about them.
    """
    by_setting = {name: _arrays(numbers) for name, numbers in part["settings"].items()}
    reference = by_setting[WINDOW_REFERENCE.name]
    rows = []
    for setting in (*SETTINGS, WINDOW_REFERENCE):
        against = None if setting == WINDOW_REFERENCE else reference
        rows += _window(pair, setting, by_setting[setting.name], against)
    return rows


def _window(
    pair: str,
    setting: Setting,
    mine: Mapping[str, np.ndarray],
    reference: Mapping[str, np.ndarray] | None,
) -> list[Row]:
    touching = mine["touched"] > 0
    windows, episodes = mine["touched"][touching], int(touching.sum())
    rows = []
    for name in ("impulse", "peak_force", "penetration"):
        each = mine[name][touching]
        difference = None
        if reference is not None:
            theirs = reference[name][touching]
            # The overlap's limit is a length.
            deeper = _per_window(each - theirs, windows)
            difference = deeper if name == "penetration" else relative(each, theirs)
        value = _per_window(each, windows)
        rows.append(_row("windows", pair, setting, name, episodes, value, difference))
    if reference is not None:
        total = reference["impulse"][touching]
        error = _per_window(mine["impulse_error"][touching], total)
        rows.append(_row("windows", pair, setting, "impulse_error", episodes, error))
        for name in ("angles", "angles_rad", "features"):
            rows.append(_row("windows", pair, setting, name, len(mine[name]), mean(mine[name])))
    return rows


def _arrays(numbers: Mapping[str, Any]) -> dict[str, np.ndarray]:
    return {name: np.array(values, dtype=float) for name, values in numbers.items()}


def _per_window(sums: Float[np.ndarray, " n"], counts: Float[np.ndarray, " n"]) -> Estimate:
    """Mean over all windows from sums by episode."""
    found = relative(sums, counts)
    return Estimate(*(one + 1 for one in found))


def _row(
    part: str,
    case: str,
    setting: Setting,
    number: str,
    count: int,
    value: Estimate | float,
    difference: Estimate | None = None,
) -> Row:
    """A row; `n` is the number of episodes, swings or turns behind it."""
    known = value if isinstance(value, Estimate) else (value, None, None)
    ends = (*known, *(difference or (None, None, None)))
    return {
        "part": part, "case": case, "step": setting.step, "substeps": setting.substeps,
        "number": number, "n": count, **dict(zip(_COLUMNS, ends, strict=True)),
    }  # fmt: skip
