"""The referees of one adversary at every level, and what they say with its standard error.

A level is what is judged: single steps or 16-step windows. Canonical data come in folds of whole
episodes: one (train, validation, test) where there is plenty, K of them where people were recorded
and each episode is precious. A fold has a referee of its own, whose false alarms are counted on
canonical episodes that neither its training nor its selection saw.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float, PRNGKeyArray

from rigid.naturalness.logistic import Sample, Side, padded
from rigid.naturalness.rates import Rate, rate
from rigid.naturalness.referee import (
    HEADLINE_KAPPA,
    Referee,
    RefereeSettings,
    fit_member,
    least_loss,
    log_ratio,
)
from rigid.naturalness.standardise import Scale, canonical_scale, standardise
from rigid.naturalness.views import VIEWS, Episodes, all_sound, sound_windows, windows


class Level(NamedTuple):
    """What is judged, and with which κ."""

    name: str
    length: int
    """Control steps in a window."""
    stride: int
    """Distance of the windows that validate; neighbours say nearly the same (ours)."""
    kappas: tuple[float, ...]


LEVELS = (Level("step", 1, 1, (1.0, 4.0)), Level("window16", 16, 4, (1.0, 4.0, 16.0)))
"""Windows of 1.6 s in itch scratching."""
AXIS = f"step_k{HEADLINE_KAPPA:g}"
"""The level on the x axis."""
LEVEL_NAMES = tuple(f"{level.name}_k{kappa:g}" for level in LEVELS for kappa in level.kappas)


@dataclass(frozen=True)
class Fold:
    """Canonical features by use; no adversary was ever trained with any of them."""

    train: Float[np.ndarray, "E1 T f"]
    validation: Float[np.ndarray, "E2 T f"]
    test: Float[np.ndarray, "E3 T f"]

    @cached_property
    def _sides(self) -> dict[tuple[int, str], tuple[Scale, Side]]:
        return {}

    def side(self, level: Level, view: str) -> tuple[Scale, Side]:
        """Inputs of canonical motion in one view, and their frozen scale; made once."""
        known = self._sides.get((level.length, view))
        if known is not None:
            return known
        scale = canonical_scale(_inputs(all_sound(self.train), level.length, 1, view))
        parts = all_sound(self.train), all_sound(self.validation)
        found = scale, _side(scale, level, view, *parts)
        self._sides[level.length, view] = found
        return found


class Jury(NamedTuple):
    """The referees of one adversary at one level, one for each fold."""

    referees: tuple[Referee, ...]
    alarms: Mapping[float, Rate]
    """For each κ the share of held-out canonical windows that they take for the adversary's."""


Panel = dict[str, Jury]
"""By the level's name; without those whose windows are longer than an episode."""


def split_in_folds(features: Float[np.ndarray, "E T f"], folds: int) -> tuple[Fold, ...]:
    """K folds of whole episodes: one K-th tests, the next one validates, the rest trains.

    Raises:
        ValueError: There are fewer than 3 folds, or fewer episodes than folds.
    """
    if not 3 <= folds <= len(features):
        raise ValueError(f"{len(features)} episodes cannot be split in {folds} folds of three uses")
    parts = np.array_split(features, folds)
    return tuple(
        Fold(
            np.concatenate([parts[(k + shift) % folds] for shift in range(2, folds)]),
            parts[(k + 1) % folds],
            parts[k],
        )
        for k in range(folds)
    )


def train_panels(
    folds: Sequence[Fold],
    adversaries: Sequence[tuple[Episodes, Episodes]],
    settings: RefereeSettings,
    key: PRNGKeyArray,
    *,
    each: Callable[[], None] = lambda: None,
) -> list[Panel]:
    """The panels of a group of adversaries, given (train, validation) of each.

    One after the other: nothing that is fitted for one depends on who else is in the group. `each`
    is called after each of them.
    """
    panels = []
    for index, episodes in enumerate(adversaries):
        panels.append(train_panel(folds, *episodes, settings, jax.random.fold_in(key, index)))
        each()
    return panels


def train_panel(
    folds: Sequence[Fold],
    train: Episodes,
    validation: Episodes,
    settings: RefereeSettings,
    key: PRNGKeyArray,
    levels: Sequence[Level] = LEVELS,
) -> Panel:
    """Referees of one adversary at every level that its episodes are long enough for.

    Args:
        folds: The canonical side.
        train: Episodes of the adversary to learn from.
        validation: Others, to stop early and to choose from the family by.
        settings: The recipe.
        key: Consumed.
        levels: At which levels.
    """
    panel = {}
    for level in levels:
        if not all(_any_sound(part, level.length) for part in (train, validation)):
            continue
        referees = tuple(
            _train(fold, level, train, validation, settings, jax.random.fold_in(key, number))
            for number, fold in enumerate(folds)
        )
        ratios = np.concatenate([
            _ratios(referee, fold.test) for referee, fold in zip(referees, folds, strict=True)
        ])  # fmt: skip
        every = np.ones(ratios.shape, dtype=bool)
        alarms = {kappa: rate(ratios >= np.log(kappa), every) for kappa in level.kappas}
        panel[level.name] = Jury(referees, alarms)
    return panel


def naturalness(panel: Panel, episodes: Episodes) -> dict[str, Rate | None]:
    """Overlap on held-out episodes of the adversary, by `LEVEL_NAMES`; None where unknown.

    The error is that of the episodes of both sides; that of training another referee is not in it.
    """
    found: dict[str, Rate | None] = dict.fromkeys(LEVEL_NAMES)
    for level in LEVELS:
        jury = panel.get(level.name)
        if jury is None or not _any_sound(episodes, level.length):
            continue
        sound = sound_windows(episodes.sound, level.length)
        ratios = np.stack([_ratios(referee, episodes.features) for referee in jury.referees])
        for kappa, alarms in jury.alarms.items():
            passed = rate((ratios < np.log(kappa)).mean(axis=0), sound)
            found[f"{level.name}_k{kappa:g}"] = _sum(passed, alarms, kappa)
    return found


def _sum(passed: Rate, alarms: Rate, kappa: float) -> Rate:
    value = min(1.0, passed.value + kappa * alarms.value)
    if passed.se is None or alarms.se is None:
        return Rate(value, None)
    return Rate(value, float(np.hypot(passed.se, kappa * alarms.se)))


def _train(
    fold: Fold,
    level: Level,
    train: Episodes,
    validation: Episodes,
    settings: RefereeSettings,
    key: PRNGKeyArray,
) -> Referee:
    fitted = []
    for number, member in enumerate(settings.members(level.length)):
        scale, canonical = fold.side(level, member.view)
        adversary = _side(scale, level, member.view, train, validation)
        blank = Referee([], scale, level.length, member.view)
        fitted.append(
            fit_member(blank, member, canonical, adversary, jax.random.fold_in(key, number))
        )
    return least_loss(fitted)


def _side(scale: Scale, level: Level, view: str, train: Episodes, validation: Episodes) -> Side:
    def sample(episodes: Episodes, stride: int) -> Sample:
        return padded(standardise(scale, _inputs(episodes, level.length, stride, view)))

    return Side(sample(train, 1), sample(validation, level.stride))


def _inputs(episodes: Episodes, length: int, stride: int, view: str) -> Float[np.ndarray, "n d"]:
    """The sound windows of all episodes as rows."""
    seen = windows(episodes.features, length)[:, ::stride]
    kept = seen[sound_windows(episodes.sound, length)[:, ::stride]]
    return np.asarray(VIEWS[view](kept), dtype=np.float32)


def _ratios(referee: Referee, features: Float[np.ndarray, "E T f"]) -> Float[np.ndarray, "E W"]:
    """The log-ratio of every window, sound or not."""
    if referee.length == 1:
        return log_ratio(referee, features)
    return log_ratio(referee, windows(features, referee.length))


def _any_sound(episodes: Episodes, length: int) -> bool:
    if episodes.features.shape[1] < length:
        return False
    return bool(sound_windows(episodes.sound, length).any())
