"""How much each search may spend, on which robots, with how many seeds."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from benchmarks.planted.handover import HORIZON
from rigid.learning.conditioned import Sharing

METHODS = ("rigid", "clone", "diversity", "sabotage", "noise")
"""Ours first; decoys are only searched by it."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A study; all values ours."""

    name: str
    weaknesses: tuple[int, ...] = tuple(range(10))
    """Which of the ten."""
    methods: tuple[str, ...] = METHODS
    seeds: tuple[int, ...] = (0,)
    humans: int = 8
    """Humans that every method ends with; ours trains them all in one round."""
    lambda_min: float = 0.05
    lambda_max: float = 3.0
    iterations: int = 100
    """Of one adversary."""
    episodes: int = 100
    """Of one iteration: 4,000 steps."""

    @property
    def sharing(self) -> Sharing:
        """One network from the canonical human for all λ: every human here has to be natural."""
        return Sharing(natural_start=0.0, natural_slots=self.humans, natural_from=self.lambda_min)

    @property
    def steps(self) -> int:
        """Environment steps that each method may spend on one robot."""
        return self.humans * self.iterations * self.episodes * HORIZON

    def parts(self) -> list[tuple[int, str, int]]:
        """Weakness, method (or `decoy`) and seed of every part, the search of ours first."""
        order = (self.methods[0], "decoy", *self.methods[1:])
        return [
            (weakness, method, seed)
            for method in order
            for seed in self.seeds
            for weakness in self.weaknesses
        ]

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        return {**asdict(self), "sharing": asdict(self.sharing)}


PLAN = Plan(name="planted")
QUICK = Plan(
    name="quick: shows that the road works, and nothing else",
    weaknesses=(0, 8), humans=3, iterations=3, episodes=40,
)  # fmt: skip
