"""What the study trains: variants of the search, and sizes of the canonical set."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from benchmarks.short_search import EPISODES, ITERATIONS, QUICK_PRESET, short_settings
from rigid.learning.adversary_settings import AdversarySettings
from rigid.naturalness.features import DEFAULT, OBSERVATION, OBSERVATION_ACTION
from rigid.presets import Preset

TASK = "itch-scratching"
ROBOT = "builtin:vanilla"
HUMAN = "builtin:synthetic-human"


@dataclass(frozen=True, kw_only=True)
class Variant:
    """One way to train adversaries."""

    name: str
    """Its directory, and its name in the tables."""
    factor: str
    """What it changes; empty for the default."""
    settings: AdversarySettings
    features: str = DEFAULT
    """What its discriminator sees; its adversaries are judged on the default features."""

    def describe(self) -> dict[str, Any]:
        """Every setting, as JSON, which knows no infinity."""
        settings = asdict(self.settings)
        start = settings["natural_start"]
        settings["natural_start"] = "inf" if math.isinf(start) else start
        return {"settings": settings, "features": self.features}


@dataclass(frozen=True, kw_only=True)
class Sizes:
    """The second half: readings of fixed humans against the number of canonical episodes."""

    episodes: tuple[int, ...]
    """Sizes n, ascending, each a divisor of the last."""
    repeats: int
    """Fresh canonical sets, each with fresh random weights."""
    iterations: int
    """Of the discriminator, `DiscriminatorSettings.steps` gradient steps each."""
    train: int
    """Episodes of each human that judges learn from."""
    validation: int
    """Others on which the referee stops early."""
    test: int
    """Others that are read."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The study."""

    preset: Preset
    lambdas: tuple[float, ...]
    """The same for every variant, ascending."""
    only: tuple[str, ...] | None
    """Names of the variants that are tried, the default apart; None for all."""
    sizes: Sizes
    command: str

    @property
    def default(self) -> Variant:
        """The search as it is, but for its short training."""
        return Variant(name="default", factor="", settings=short_settings(self.preset))

    def variants(self) -> list[Variant]:
        """The default, then everything that departs from it in one thing."""
        others = variants_of(self.default.settings)
        return [self.default, *(v for v in others if self.only is None or v.name in self.only)]

    def with_seeds(self, seeds: Sequence[int]) -> Plan:
        """The same study with other search seeds."""
        return replace(self, preset=replace(self.preset, seeds=tuple(seeds)))


def variants_of(base: AdversarySettings) -> list[Variant]:
    """Everything that is tried beside `base`."""

    def discriminator(name: str, factor: str, **changes: Any) -> Variant:
        changed = replace(base.discriminator, **changes)
        return Variant(name=name, factor=factor, settings=replace(base, discriminator=changed))

    def start(name: str, natural_start: float) -> Variant:
        settings = replace(base, natural_start=natural_start)
        return Variant(name=name, factor="start", settings=settings)

    def features(chosen: str) -> Variant:
        return Variant(name=chosen, factor="features", settings=base, features=chosen)

    return [
        discriminator("no-noise", "noise", noise=0.0, noise_floor=0.0),
        # As printed, and the paper names no floor.
        discriminator("paper-noise", "noise", noise=10.0, noise_decay=0.98, noise_floor=0.0),
        discriminator("constant-noise", "noise", noise_decay=1.0),
        discriminator("gradient-penalty-0", "gradient penalty", gradient_penalty=0.0),
        discriminator("gradient-penalty-5", "gradient penalty", gradient_penalty=5.0),
        discriminator("weights-1-to-1", "class weights", canonical_weight=1.0),
        discriminator("weights-16-to-1", "class weights", canonical_weight=16.0),
        features(OBSERVATION),
        features(OBSERVATION_ACTION),
        start("canonical-start", 0.0),
        start("random-start", math.inf),
        discriminator("no-replay", "replay", replay_share=0.0),
    ]


PLAN = Plan(
    # About 20 minutes on two cores: 117 adversaries. Ours.
    preset=Preset(
        name="ablations",
        seeds=(0, 1, 2),
        per_round=(3,),
        iterations=ITERATIONS,
        episodes=EPISODES,
        scoring_episodes=60,
        referee_episodes=30,
        validation_episodes=15,
    ),
    # Below, in and above the rise of naturalness that the default has here (measured); the first
    # below the λ from which on it starts canonical, so that both other starts depart from it. Ours.
    lambdas=(0.05, 0.4, 1.6),
    only=None,
    sizes=Sizes(
        episodes=(5, 10, 20, 40, 80, 160), repeats=3, iterations=20, train=60, validation=30,
        test=60,
    ),
    command="python -m benchmarks.ablations",
)  # fmt: skip
QUICK = Plan(
    preset=replace(
        QUICK_PRESET,
        name="ablations-quick",
        per_round=(3,),
        stamp="quick: budgets that say nothing about any variant",
    ),
    lambdas=(0.05, 0.4, 1.6),
    only=("no-noise", OBSERVATION, "canonical-start"),
    sizes=Sizes(episodes=(5, 10), repeats=2, iterations=2, train=6, validation=3, test=6),
    command="python -m benchmarks.ablations --quick",
)
