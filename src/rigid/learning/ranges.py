"""Which λ the networks of many are trained at, and what each of their slots plays.

A family trains at a range of λ a little wider than the λ that were asked of it; at each iteration
its slots play at even places of the range, each a little off its own. Ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.conditioned import Sharing, codes_at, draw_places, lambda_at, slot_of
from rigid.naturalness.side_by_side import SideBySide


class Range(NamedTuple):
    """The ascending λ between which one family trains, and how many of them it plays at a time."""

    lambdas: tuple[float, ...]
    """Those that were asked for, and the one that it trains at for their sake."""
    asked: tuple[float, ...]
    slots: int
    natural: bool
    """Whether it starts at the synthetic human."""

    def codes(self) -> Float[np.ndarray, "L c"]:
        """The code of each λ."""
        return codes_at(np.arange(len(self.lambdas), dtype=float), len(self.lambdas))

    def slot(self, lambda_: float) -> int:
        """The slot that plays nearest to one of `lambdas`."""
        return slot_of(self.lambdas.index(lambda_), len(self.lambdas), self.slots)

    def measures(self, settings: AdversarySettings) -> SideBySide:
        """One search measure for each slot."""
        return SideBySide(settings.search_measure, self.slots)

    def remembered(self, settings: AdversarySettings) -> float:
        """Share of its average that outlives an iteration; 0: the average is the last network."""
        if settings.sharing is None or not self.natural:
            return 0.0
        return 1 - 1 / max(settings.sharing.natural_average * settings.iterations, 1.0)

    def kept(self, lambda_: float, settings: AdversarySettings) -> float:
        """Share of the way from the synthetic human that the adversary of one λ keeps."""
        sharing = settings.sharing
        if sharing is None or not self.natural or lambda_ < sharing.retreat_from:
            return 1.0
        return 1 - sharing.retreat


class Drawn(NamedTuple):
    """What the slots of one family play in one iteration."""

    lambdas: Float[Array, " S"]
    codes: Float[Array, "S c"]


def ranges_of(lambdas: Sequence[float], sharing: Sharing) -> list[Range]:
    """The λ of each family that was asked for any; the wild one comes first.

    Example:
        >>> for each in ranges_of([3.0, 0.0], Sharing(wild_slots=2, natural_slots=3)):
        ...     print(each)
        Range(lambdas=(0.0, 0.4), asked=(0.0,), slots=2, natural=False)
        Range(lambdas=(0.1, 3.0), asked=(3.0,), slots=3, natural=True)
    """
    wild = {value for value in lambdas if value < sharing.natural_start}
    natural = set(lambdas) - wild
    families = (
        (wild, sharing.wild_to, sharing.wild_slots, False),
        (natural, sharing.natural_from, sharing.natural_slots, True),
    )
    return [
        Range(tuple(sorted(asked | {beyond})), tuple(sorted(asked)), slots, from_human)
        for asked, beyond, slots, from_human in families
        if asked
    ]


def draw(range_: Range, rng: np.random.Generator) -> Drawn:
    """A λ and its code for each slot, near its own; see `draw_places`."""
    count = len(range_.lambdas)
    places = draw_places(count, range_.slots, rng)
    lambdas = jnp.array([lambda_at(range_.lambdas, place) for place in places])
    return Drawn(lambdas, jnp.asarray(codes_at(places, count)))
