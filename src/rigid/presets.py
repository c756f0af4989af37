"""How much a measurement spends: `demo`, `standard` and `paper`."""

from __future__ import annotations

import difflib
from dataclasses import asdict, dataclass
from typing import Any

from rigid.errors import UserError
from rigid.learning.conditioned import Sharing

COMPANIONS = 2
"""Canonical episodes beside the two replays of each adversary."""


@dataclass(frozen=True, kw_only=True)
class Preset:
    """Which λ are trained, for how long, and how carefully they are scored."""

    name: str
    seeds: tuple[int, ...]
    """Search seeds; each is one independent history of Algorithm 1."""
    per_round: tuple[int, ...]
    """New λ in each round, for each seed: the first round spans the range, later ones refine."""
    iterations: int
    """Policy updates of one adversary."""
    episodes: int
    """Episodes between two updates."""
    scoring_episodes: int
    """Fresh episodes on which each adversary is scored."""
    referee_episodes: int
    """Episodes of each adversary for the referee to learn from."""
    validation_episodes: int
    """Episodes of each adversary on which the referee stops early and λ is refined."""
    lambda_min: float = 1e-5
    lambda_max: float = 10.0
    """Range of λ (paper, appendix 'Additional Details of the Natural-Adversarial Frontier')."""
    search_canonical: int = 40
    """Canonical episodes that the search may see (paper, 'Collecting Canonical Datasets')."""
    referee_canonical: int = 100
    """Canonical episodes in each of the referee's three parts. Ours."""
    sharing: Sharing | None = None
    """How many λ share a network; None: a network for each λ, as in the paper."""
    stamp: str | None = None
    """Printed on the report."""

    @property
    def adversaries(self) -> int:
        """Policies trained in all."""
        return len(self.seeds) * sum(self.per_round)

    def env_steps(self, horizon: int) -> int:
        """Environment steps of training in all."""
        groups = len(self.seeds) * len(self.per_round)
        blocks = self.adversaries if self.sharing is None else groups * self.sharing.slots
        return blocks * self.iterations * self.episodes * horizon

    @property
    def judging_episodes(self) -> int:
        """Episodes of each adversary for its referee and its score."""
        return self.referee_episodes + self.validation_episodes + self.scoring_episodes

    def scoring_steps(self, adversaries: int, horizon: int) -> int:
        """Environment steps that score so many adversaries."""
        return adversaries * (self.judging_episodes + COMPANIONS) * horizon

    def describe(self) -> dict[str, Any]:
        """Every number, as JSON."""
        return asdict(self)


PRESETS = {
    # As `standard`, with half the iterations and two seeds, one for each core of a small machine.
    "demo": Preset(
        name="demo",
        seeds=(0, 1),
        per_round=(8,),
        iterations=40,
        episodes=6,
        scoring_episodes=60,
        referee_episodes=40,
        validation_episodes=24,
        lambda_min=0.03,
        # It ends before its networks come to rest: an average would be of networks on their way.
        sharing=Sharing(natural_average=0.0, retreat=0.0),
        stamp="demo: not for publication",
    ),
    "standard": Preset(
        name="standard",
        seeds=tuple(range(8)),
        per_round=(8,),
        iterations=80,
        episodes=6,
        scoring_episodes=100,
        referee_episodes=60,
        validation_episodes=30,
        lambda_min=0.03,
        sharing=Sharing(),
    ),
    # Paper, appendices 'Computational Complexity' and 'Additional Details of the ... Frontier'.
    "paper": Preset(
        name="paper",
        seeds=(0, 1, 2),
        per_round=(6, 6, 6),
        iterations=120,
        episodes=48,
        scoring_episodes=200,
        referee_episodes=100,
        validation_episodes=50,
    ),
}


def find_preset(name: str) -> Preset:
    """The preset called `name`; raises `UserError` listing the presets."""
    if name not in PRESETS:
        close = difflib.get_close_matches(name, PRESETS, n=1)
        suggestion = f", did you mean {close[0]!r}?" if close else ";"
        raise UserError(f"preset {name!r} is unknown{suggestion} presets: {', '.join(PRESETS)}")
    return PRESETS[name]
