"""What the study searches with: measures, seeds and one budget for all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from benchmarks.short_search import EPISODES, ITERATIONS, QUICK_PRESET
from rigid.naturalness.choice import DEFAULT_MEASURE
from rigid.presets import Preset

TASK = "itch-scratching"
ROBOT = "builtin:vanilla"
REFERENCE = DEFAULT_MEASURE
ENSEMBLE = "ensemble"
MEMBERS = (REFERENCE, "mmd")
"""Measures of their own that the ensemble is made of. Its third kind, a discriminator of 16 steps,
is half of `temporal` and none alone."""
AGAIN_SHIFT = 1000
"""Added to the seeds of a second search. Ours: any number beyond all seeds."""


@dataclass(frozen=True)
class Search:
    """All searches of one measure."""

    name: str
    """Its directory, and its name in the tables."""
    measure: str
    shift: int = 0
    """Added to every seed."""

    def seeds(self, seeds: Sequence[int]) -> tuple[int, ...]:
        """What it is searched with, for the seeds of the study."""
        return tuple(seed + self.shift for seed in seeds)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The study."""

    preset: Preset
    measures: tuple[str, ...]
    """The first is the one that all others are compared with."""
    command: str

    def searches(self) -> list[Search]:
        """Each measure once, then reference and ensemble a second time, with other seeds.

        What a measure finds alone is told from what just one more search finds by the second search
        of the reference; that of the ensemble equals the two searches of its members in budget.
        """
        again = [name for name in (REFERENCE, ENSEMBLE) if name in self.measures]
        return [
            *(Search(name, name) for name in self.measures),
            *(Search(again_name(name), name, AGAIN_SHIFT) for name in again),
        ]

    def with_seeds(self, seeds: Sequence[int]) -> Plan:
        """The same study with other search seeds."""
        return replace(self, preset=replace(self.preset, seeds=tuple(seeds)))


def again_name(name: str) -> str:
    """The second search of a measure.

    Example:
        >>> again_name("lsgan")
        'lsgan-again'
    """
    return f"{name}-again"


PLAN = Plan(
    # About 20 minutes on two cores: 27 searches of 4 λ. Ours.
    preset=Preset(
        name="measures",
        seeds=(0, 1, 2),
        per_round=(3, 1),
        iterations=ITERATIONS,
        episodes=EPISODES,
        scoring_episodes=60,
        referee_episodes=30,
        validation_episodes=16,
        # With so few λ only one may be spent on sabotage, from random weights.
        lambda_min=0.05,
    ),
    measures=("lsgan", "mmd", "kl", "kl-gan", "temporal", "ensemble", "paper_d2"),
    command="python -m benchmarks.measures",
)
QUICK = Plan(
    preset=replace(
        QUICK_PRESET,
        name="measures-quick",
        stamp="quick: budgets that say nothing about any measure",
    ),
    measures=("lsgan", "mmd", "ensemble"),
    command="python -m benchmarks.measures --quick",
)
