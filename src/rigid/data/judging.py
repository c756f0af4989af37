"""Which recorded episodes can be used, and what is wrong with each of the others.

A bad episode is named and left out, never mended: what nobody recorded is not made up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.data.layout import SEED, Layout
from rigid.data.resampling import Steps
from rigid.data.takes import Take
from rigid.tasks.protocol import Task

LONGEST_GAP = 1.5
"""Times between two samples that are longer than this many typical ones, and than a control period,
are gaps: half a sample of jitter is usual, a lost sample is not. Ours."""
SLOWEST = 3
"""Control periods between two samples of a recording that is too slow to show what people did at
each step. Ours: four samples a second still show a reach of a second, one does not."""
FROZEN_SHARE = 0.5
"""A signal that moves in most episodes and holds the very same number for this share of an episode
is a sensor that froze: noise moves the last digits of one that lives. Ours."""
SLACK = 0.01
"""Actions may exceed [-1, 1] by this much: rounding of exports. Ours."""


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What is said of one episode."""

    episode: str
    participant: str
    rows: int
    seconds: float | None
    """None where rows are control steps of unknown length, or the clock is broken."""
    used: bool = True
    reason: str = ""
    """Why it cannot be used; empty where it is."""
    remark: str = ""
    """What was done to an episode that is used."""

    def as_json(self) -> dict[str, Any]:
        """For programs."""
        return asdict(self)

    def refused(self, *reasons: str | None) -> Verdict:
        """The same, with the first reason against it; None is none."""
        against = next((reason for reason in reasons if reason is not None), None)
        return self if against is None else replace(self, used=False, reason=against)


def judge_take(
    take: Take, layout: Layout, *, steps: int, period: float, sampled: bool, robot: str | None
) -> Verdict:
    """What can be said of a take before it is resampled.

    Args:
        take: The episode.
        layout: The columns that are needed.
        steps: T of the task.
        period: Control period [s].
        sampled: Whether rows are samples in time.
        robot: The robot that canonical episodes are of; None for any.
    """
    span = float(take.clock[-1] - take.clock[0])
    verdict = Verdict(
        episode=take.name, participant=take.note().participant, rows=len(take.clock),
        seconds=round(span, 3) if sampled and np.isfinite(span) else None,
    )  # fmt: skip
    verdict = verdict.refused(_mixed(take), _of_another_robot(take, robot), _seed(take))
    if verdict.used and sampled:
        # With a broken clock nothing else can be told.
        verdict = verdict.refused(
            _clock(take)
            or _slow(take, period)
            or _length(take, steps, period)
            or _gap(take, period)
        )
    elif verdict.used:
        verdict = verdict.refused(_count(take, steps), _numbering(take))
    if not verdict.used:
        return verdict
    used = _used_rows(take, steps, steps * period if sampled else None)
    verdict = verdict.refused(_missing(take, layout, used), _choices(take, layout, used))
    beyond = span - steps * period if sampled else (len(take.clock) - steps) * period
    if verdict.used and beyond > 1.5 * period:
        return replace(verdict, remark=f"cut to the first {steps} steps ({beyond:.1f} s left out)")
    return verdict


def judge_steps(
    verdicts: Sequence[Verdict],
    episodes: Sequence[Steps],
    task: Task,
    limits: Mapping[str, tuple[float, float]],
) -> list[Verdict]:
    """What can be said of sound episodes once they are control steps, side by side.

    Args:
        verdicts: Of the episodes, all used so far.
        episodes: On control steps.
        task: Names the features.
        limits: Of features by name, in the task's units.
    """
    names = task.feature_names
    moving = _moving(episodes)
    known: dict[bytes, str] = {}
    judged = []
    for verdict, steps in zip(verdicts, episodes, strict=True):
        key = steps.features.tobytes() + (b"" if steps.actions is None else steps.actions.tobytes())
        twin = known.setdefault(key, verdict.episode)
        again = None if twin == verdict.episode else f"the same as episode {twin!r}"
        odd = _frozen(steps, names, moving), _outside(steps, names, limits)
        judged.append(verdict.refused(again, *odd))
    return judged


def _mixed(take: Take) -> str | None:
    for name in ("participant", "robot"):
        found = take.texts.get(name, ())
        if len(found) > 1:
            return f"mixed: {name}s {', '.join(repr(text) for text in found)} in one episode"
    return None


def _of_another_robot(take: Take, robot: str | None) -> str | None:
    met = take.note().robot
    return f"met robot {met!r}, not {robot!r}" if robot is not None and met != robot else None


def _seed(take: Take) -> str | None:
    seed = take.ends.get(SEED, np.nan)
    if np.isnan(seed) or (seed == np.round(seed) and 0 <= seed <= 2**53):  # Exact in a float.
        return None
    return f"seed {seed:g} is none: a seed is a whole number, 0 or more"


def _clock(take: Take) -> str | None:
    if not np.isfinite(take.clock).all():
        return f"time is missing at row {int(np.argmin(np.isfinite(take.clock))) + 1}"
    falls = np.flatnonzero(np.diff(take.clock) <= 0)
    if len(falls):
        row = int(falls[0])
        before, after = take.clock[row : row + 2]
        return f"time does not rise: row {row + 2} is at {after:g} s, after one at {before:g} s"
    return None


def _slow(take: Take, period: float) -> str | None:
    """A clock in another unit, or samples too far apart to tell one step from the next."""
    if len(take.clock) < 2:
        return None
    typical = float(np.median(np.diff(take.clock)))
    if typical <= SLOWEST * period * (1 + 1e-6):
        return None
    told = f"one sample every {typical:.4g} s, but a step of the task is {period:g} s"
    # Nobody records motion at less than 1 Hz, and hardly at more than 1 kHz.
    unit = next((name for least, name in ((1e6, "ns"), (1e3, "us"), (1.0, "ms"))
                 if typical >= least), None)  # fmt: skip
    if unit is None:
        return f"{told}: record at {1 / (SLOWEST * period):.3g} Hz or more"
    return f'{told}: is `time` in {unit}? give "unit": "{unit}" in --map'


def _numbering(take: Take) -> str | None:
    steps = np.diff(take.clock)
    odd = np.flatnonzero(steps != 1)  # NaN is not 1 either.
    if not len(odd):
        return None
    row = int(odd[0])
    return f"gap: step {take.clock[row + 1]:g} follows step {take.clock[row]:g}"


def _length(take: Take, steps: int, period: float) -> str | None:
    if len(take.clock) < 2:
        return "too short: 1 sample"
    typical = float(np.median(np.diff(take.clock)))
    span, needed = float(take.clock[-1] - take.clock[0]), steps * period
    # The last sample may stand for what follows until the next one would have come.
    if span + min(typical, period) * (1 + 1e-6) < needed:
        return f"too short: {span:.2f} s of {needed:g} s"
    return None


def _count(take: Take, steps: int) -> str | None:
    rows = len(take.clock)
    return f"too short: {rows} of {steps} steps" if rows < steps else None


def _gap(take: Take, period: float) -> str | None:
    between = np.diff(take.clock)
    row = int(np.argmax(between))
    longest = max(LONGEST_GAP * float(np.median(between)), period * (1 + 1e-6))
    if between[row] <= longest:
        return None
    at = take.clock[row] - take.clock[0]
    return f"gap: no sample for {between[row]:.2f} s from {at:.2f} s on"


def _used_rows(take: Take, steps: int, needed: float | None) -> slice:
    """Rows of the first `needed` seconds, or of the first `steps` where rows are steps."""
    if needed is None:
        return slice(steps)
    return slice(int(np.searchsorted(take.clock, take.clock[0] + needed)) + 1)


def _missing(take: Take, layout: Layout, rows: slice) -> str | None:
    for name in layout.columns:
        bad = ~np.isfinite(take.signals[name][rows])
        if bad.any():
            row = int(np.argmax(bad))
            return f"no number in {int(bad.sum())} rows of {name!r}, the first is row {row + 1}"
    return None


def _choices(take: Take, layout: Layout, rows: slice) -> str | None:
    """A choice that the task does not offer."""
    if not layout.choices or layout.actions is None:
        return None
    for source, count in zip(layout.actions, layout.choices, strict=True):
        chosen = take.signals[source.column][rows]
        odd = chosen[(chosen != np.round(chosen)) | (chosen < 0) | (chosen >= count)]
        if len(odd):
            return f"out of range: {source.column!r} is {odd[0]:g}, no choice from 0 to {count - 1}"
    return None


def _moving(episodes: Sequence[Steps]) -> np.ndarray:
    """Features that move in more than half of the episodes, at most steps."""
    if not episodes:
        return np.zeros(0, dtype=bool)
    still = np.stack([_longest_hold(steps.features) for steps in episodes])
    moves: np.ndarray = np.median(still, axis=0) < FROZEN_SHARE
    return moves


def _longest_hold(features: Float[np.ndarray, "T F"]) -> Float[np.ndarray, " F"]:
    """For each feature the longest share of the episode in which it holds one number exactly."""
    length, held = np.ones(features.shape[1]), np.ones(features.shape[1])
    for same in features[1:] == features[:-1]:
        held = np.where(same, held + 1, 1)
        length = np.maximum(length, held)
    return length / len(features)


def _frozen(steps: Steps, names: Sequence[str], moving: np.ndarray) -> str | None:
    held = _longest_hold(steps.features)
    for index in np.flatnonzero(moving & (held >= FROZEN_SHARE)).tolist():
        return f"frozen: {names[index]!r} holds one number for {held[index]:.0%} of the episode"
    return None


def _outside(
    steps: Steps, names: Sequence[str], limits: Mapping[str, tuple[float, float]]
) -> str | None:
    for index, name in enumerate(names):
        low, high = limits.get(name, (-np.inf, np.inf))
        column = steps.features[:, index]
        worst = float(column[np.argmax(np.maximum(low - column, column - high))])
        if not low <= worst <= high:
            return f"out of range: {name!r} is {worst:.3g}, outside [{low:.3g}, {high:.3g}]"
    if steps.actions is not None and steps.actions.size:
        index = int(np.argmax(np.abs(steps.actions).max(axis=0)))
        worst = float(steps.actions[np.argmax(np.abs(steps.actions[:, index])), index])
        if abs(worst) > 1 + SLACK:
            return f"out of range: action {index} is {worst:.3g}, outside [-1, 1]"
    return None
