"""Checks of the referee's recipe against known answers: canonical data, shuffles, planted shifts.

Each is run with the numbers of episodes that a measurement uses, on real canonical episodes, since
a recipe that passes on easy data may fail on these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float
from scipy.stats import norm

from rigid.naturalness.panel import (
    LEVELS,
    Fold,
    Level,
    Panel,
    naturalness,
    train_panel,
    train_panels,
)
from rigid.naturalness.referee import RefereeSettings
from rigid.naturalness.views import Episodes, all_sound

SPLITS = 20
"""Of canonical data into a canonical and a pretended adversarial part."""
SHUFFLES = 5
"""Of the labels of canonical episodes and sabotage. Ours."""
SHIFTS = (0.5, 1.0, 2.0, 3.0)
"""Planted ones, in standard deviations. Ours."""
COMPANY = 11
"""Sabotage adversaries that join the run of a natural one."""

Values = dict[str, float]
"""Naturalness by level and κ, as in `LEVEL_NAMES`."""


class Sizes(NamedTuple):
    """Episodes by use, as a preset sets them."""

    canonical: int
    """In each of the referee's three canonical parts."""
    train: int
    validation: int
    scoring: int

    @property
    def adversary(self) -> int:
        """Episodes of one adversary in all."""
        return self.train + self.validation + self.scoring

    @property
    def pool(self) -> int:
        """Canonical episodes that one split needs."""
        return 3 * self.canonical + self.adversary


class Bench(NamedTuple):
    """With what the recipe is tried."""

    sizes: Sizes
    settings: RefereeSettings
    advance: Callable[[], None] = lambda: None
    """Called after each trained panel."""


class Planted(NamedTuple):
    """A shift of known overlap, and what was read of it."""

    name: str
    shift: float
    exact: float
    found: float


def canonical_splits(
    canonical: Float[np.ndarray, "E T f"], bench: Bench, splits: int = SPLITS
) -> Iterator[Values]:
    """Canonical episodes judged against other canonical episodes: every level should read 1."""
    for number in range(splits):
        order = np.random.default_rng([0, number]).permutation(len(canonical))
        yield _split(canonical[order], bench, number)


def label_shuffles(
    canonical: Float[np.ndarray, "E T f"], sabotage: Float[np.ndarray, "E T f"], bench: Bench
) -> Iterator[Values]:
    """Both classes hold half canonical, half sabotage episodes: every level should read 1.

    Args:
        canonical: Episodes of the one kind.
        sabotage: As many of the other, none with a fault.
        bench: With what to try.
    """
    for number in range(SHUFFLES):
        rng = np.random.default_rng([1, number])
        mixed = np.stack([rng.permutation(canonical), rng.permutation(sabotage)], axis=1)
        yield _split(mixed.reshape(-1, *canonical.shape[1:]), bench, number)


def planted_shifts(
    canonical: Float[np.ndarray, "E T f"], bench: Bench, levels: Sequence[Level] = LEVELS
) -> Iterator[list[Planted]]:
    """A Gaussian shift of known overlap, hidden among the real features as one more of them.

    The further feature is N(0, 1) at every step of canonical episodes and N(m/√L, 1) of the
    pretended adversary's, so that windows of L steps differ by m standard deviations and overlap by
    `exact_overlap(m, κ)`; in everything else the two classes are canonical.
    """
    for number, shift in enumerate(SHIFTS):
        rng = np.random.default_rng([2, number])
        order = rng.permutation(len(canonical))
        noise = rng.standard_normal((*canonical.shape[:2], 1), dtype=np.float32)
        for level in levels:
            moved = noise.copy()
            moved[3 * bench.sizes.canonical :] += np.float32(shift / np.sqrt(level.length))
            both = np.concatenate([canonical[order], moved], axis=-1)
            found = _split(both, bench, number, [level])
            named = {kappa: f"{level.name}_k{kappa:g}" for kappa in level.kappas}
            yield [
                Planted(name, shift, exact_overlap(shift, kappa), found[name])
                for kappa, name in named.items()
                if name in found
            ]


def exact_overlap(shift: float, kappa: float) -> float:
    """∫ min(q, κ p) of q = N(m, 1), m > 0, and p = N(0, 1).

    Example:
        >>> round(exact_overlap(1.0, 4.0), 4), round(exact_overlap(2.0, 1.0), 4)
        (0.9308, 0.3173)
    """
    edge = np.log(kappa) / shift
    return float(norm.cdf(edge - shift / 2) + kappa * norm.cdf(-edge - shift / 2))


def moved_by_company(fold: Fold, natural: Episodes, sabotage: Episodes, bench: Bench) -> Values:
    """How far an adversary's naturalness moves when sabotage adversaries are in the same run.

    The adversary comes last, so that another random key fits its referees: chance in training
    shows here as well.
    """
    sizes = bench.sizes
    size = sizes.train + sizes.validation
    groups = [sabotage.part(slice(k * size, (k + 1) * size)) for k in range(COMPANY)]
    held_out = natural.part(slice(size, None))
    alone, joined = (
        _values(_trained([fold], [*company, natural.part(slice(size))], bench)[-1], held_out)
        for company in ([], groups)
    )
    return {name: abs(alone[name] - joined[name]) for name in alone}


def _trained(folds: Sequence[Fold], adversaries: Sequence[Episodes], bench: Bench) -> list[Panel]:
    train = bench.sizes.train
    parts = [(own.part(slice(train)), own.part(slice(train, None))) for own in adversaries]
    panels = train_panels(folds, parts, bench.settings, jax.random.key(0))
    for _ in panels:
        bench.advance()
    return panels


def _split(
    episodes: Float[np.ndarray, "E T f"],
    bench: Bench,
    number: int,
    levels: Sequence[Level] = LEVELS,
) -> Values:
    """The first episodes as canonical, the next ones as an adversary's."""
    sizes = bench.sizes
    ends = np.cumsum([sizes.canonical] * 3 + [sizes.train, sizes.validation, sizes.scoring])
    *folds, train, validation, scoring = np.split(episodes[: ends[-1]], ends[:-1])
    panel = train_panel(
        [Fold(*folds)], all_sound(train), all_sound(validation), bench.settings,
        jax.random.key(number), levels,
    )  # fmt: skip
    bench.advance()
    return _values(panel, all_sound(scoring))


def _values(panel: Panel, episodes: Episodes) -> Values:
    found = naturalness(panel, episodes)
    return {name: rate.value for name, rate in found.items() if rate is not None}
