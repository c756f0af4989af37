"""What the study tries: robots, seeds, sizes and numbers of draws."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rigid.presets import Preset

PLAUSIBLE = (0.92, 0.98)
"""Covers that a 95 % interval may have before the account names it. Ours."""

MOST_ABOVE = 0.05
"""Share of draws with the truth above an upper bound beyond which the account marks it: twice the
nominal 2.5 %. Ours."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One run of the study."""

    preset: Preset
    """Of every search; its seeds are the population that is drawn from."""
    tolerances: tuple[float, float] = (1.0, 1.5)
    """Of the two robots: how far off centre each still catches [canonical deviations]."""
    sizes: tuple[int, ...] = (3, 5, 8, 10)
    """Numbers of seeds in a draw: 3 is the paper's, 8 that of preset `standard`."""
    draws: int = 40_000
    """For each size: a cover of .95 is then known to .0011."""
    bca_size: int = 30
    """The fewest seeds for which a BCa interval is printed."""
    bca_draws: int = 2_000
    """Fewer, since each takes some milliseconds."""
    redraws: int = 200
    """Times that the seeds themselves are drawn again, for the error of having no more of them."""
    redraw_draws: int = 2_000
    """Draws for each of those."""
    seed: int = 0
    """Everything random here comes from it; searches have their own."""
    stamp: str = ""
    """Printed on the account."""

    @property
    def shown(self) -> tuple[int, ...]:
        """Sizes that figure and account look at closely: the fewest seeds, and a middle number."""
        return tuple(dict.fromkeys((self.sizes[0], self.sizes[len(self.sizes) // 2])))


PLAN = Plan(
    preset=Preset(
        name="coverage",
        seeds=tuple(range(64)),
        per_round=(5,),
        # A hand-over is one step, so that many are cheap. Fewer leave adversaries where they
        # started: the search's step is as long as its signal, which one step keeps small.
        iterations=24,
        episodes=19_200,
        scoring_episodes=400,
        referee_episodes=400,
        validation_episodes=200,
        # Between them naturalness goes from under .4 to over .95 (measured).
        lambda_min=0.05,
        lambda_max=3.0,
        search_canonical=400,
        referee_canonical=400,
    )
)

QUICK = Plan(
    preset=replace(
        PLAN.preset, name="coverage-quick", seeds=tuple(range(4)), per_round=(2,), iterations=3,
        episodes=600,
    ),
    sizes=(3,),
    draws=500,
    bca_draws=20,
    redraws=5,
    redraw_draws=100,
    stamp="\n*Quick run: its budgets say nothing about any interval.*\n",
)  # fmt: skip
