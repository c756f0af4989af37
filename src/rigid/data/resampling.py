"""From samples at any rate to the control steps of a task.

Row t of an episode holds what was seen and done before step t and the features of the state that
step t led to. So where p is the control period, observations and actions are those at t p after
the start, features those at (t + 1) p, and an episode of T steps needs the samples of T p seconds.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from rigid.data.layout import REWARD, Layout, Source
from rigid.data.takes import Take


class Steps(NamedTuple):
    """One episode of T control steps; None where the recording has no such column."""

    times: Float[np.ndarray, " T"]
    """Of the features, on the recording's own clock [s]."""
    features: Float[np.ndarray, "T F"]
    observations: Float[np.ndarray, "T O"] | None
    actions: Float[np.ndarray, "T A"] | None
    rewards: Float[np.ndarray, " T"] | None


def are_labels(columns: Sequence[np.ndarray]) -> bool:
    """Whether a signal is a label and no measurement: nothing but whole numbers in every episode.

    Ours: between two labels there is nothing, so they are taken from the nearest sample.
    """
    return all(bool(_whole(column).all()) for column in columns)


def _whole(column: Float[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    known = column[np.isfinite(column)]
    whole: np.ndarray = known == np.round(known)
    return whole


def resample(
    take: Take, layout: Layout, *, steps: int, period: float, labels: Collection[str]
) -> Steps:
    """The first `steps` control steps of a take whose rows are samples in time.

    Measurements are interpolated linearly; behind the last sample its value is held. A rate of
    change is the central difference over one control period, which noise at the recording's own
    rate does not blow up (ours). Rewards are summed over each step.

    Args:
        take: Sound: its clock rises, and no number is missing.
        layout: Its columns.
        steps: T.
        period: p [s].
        labels: Columns that are labels.
    """
    clock = take.clock - take.clock[0]
    before, after = np.arange(steps) * period, np.arange(1, steps + 1) * period

    def at(moments: np.ndarray, source: Source) -> np.ndarray:
        signal = take.signals[source.column]
        if source.rate:
            # The last moment may lie behind the last sample, by up to a control period.
            half = min(period, float(clock[-1])) / 2
            centre = np.clip(moments, half, clock[-1] - half)
            low, high = (np.interp(centre + side * half, clock, signal) for side in (-1, 1))
            return np.asarray((high - low) / (2 * half))
        if source.column in labels:
            return np.asarray(signal[_nearest(clock, moments)])
        return np.asarray(np.interp(moments, clock, signal))

    def stacked(moments: np.ndarray, sources: Sequence[Source]) -> np.ndarray:
        rows = [at(moments, source) for source in sources]
        return np.stack(rows, axis=1) if rows else np.zeros((steps, 0))

    rewards = None
    if layout.rewarded:
        within = clock < after[-1]
        # A hair forward: a sample at the very edge belongs to the step that it begins.
        numbers = np.floor(clock[within] / period + 1e-6).astype(int)
        kept = np.minimum(numbers, steps - 1)
        rewards = np.bincount(kept, weights=take.signals[REWARD][within], minlength=steps)
    return Steps(
        take.clock[0] + after, stacked(after, layout.features),
        None if layout.observations is None else stacked(before, layout.observations),
        None if layout.actions is None else stacked(before, layout.actions), rewards,
    )  # fmt: skip


def take_steps(take: Take, layout: Layout, *, steps: int, period: float) -> Steps:
    """The first `steps` rows of a take whose rows are control steps already."""

    def stacked(sources: Sequence[Source]) -> np.ndarray:
        columns = [take.signals[source.column][:steps] for source in sources]
        return np.stack(columns, axis=1) if columns else np.zeros((steps, 0))

    return Steps(
        np.arange(1, steps + 1) * period, stacked(layout.features),
        None if layout.observations is None else stacked(layout.observations),
        None if layout.actions is None else stacked(layout.actions),
        take.signals[REWARD][:steps] if layout.rewarded else None,
    )  # fmt: skip


def _nearest(clock: Float[np.ndarray, " n"], moments: Float[np.ndarray, " m"]) -> np.ndarray:
    """Of each moment the sample that is nearest in time; the earlier one of two."""
    above = np.clip(np.searchsorted(clock, moments), 1, len(clock) - 1)
    earlier = moments - clock[above - 1] <= clock[above] - moments
    return np.where(earlier, above - 1, above)
