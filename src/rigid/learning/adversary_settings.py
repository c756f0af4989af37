"""The settings of an adversary: its budget, what holds it close, and how its policy learns."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rigid.learning.conditioned import Sharing
from rigid.learning.ppo import PPOSettings
from rigid.naturalness.choice import DEFAULT_MEASURE, measure_named
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.measure import Measure

ALONE = PPOSettings(learning_rate=5e-4, minibatch=1200, update_normaliser=False, signal_floor=0.3)
"""Of an adversary with a network of its own. Ours: the paper does not give them."""
SHARED = replace(ALONE, learning_rate=1.5e-3, signal_floor=0.0)
"""Of a network that serves many λ; its minibatches are a share of an iteration. It comes to rest by
its learning rate alone: with a floor it hardly moved in as few iterations. Ours."""


@dataclass(frozen=True, kw_only=True)
class AdversarySettings:
    """Budget and machinery of one adversary; the group shares them."""

    iterations: int = 120
    """Paper, appendix 'Computational Complexity'."""
    episodes: int = 48
    """Episodes of one iteration: 4,800 steps (paper, same place)."""
    memory: int = 1
    """Observations that the adversary acts on, the newest included (the paper's human acts on local
    histories; one is enough where the observation tells the state)."""
    measure: str = DEFAULT_MEASURE
    """What holds the adversary close: a name of `rigid.naturalness.choice.MEASURES`."""
    penalty: str = "amp"
    """Which function of a discriminator's score is penalised: `amp` or `paper_d2`."""
    natural_start: float = 0.1
    """From this λ on an adversary starts at the synthetic human, below it from random weights. A
    canonical start finds natural failures that random weights miss (`benchmarks/planted`, λ about
    .2); sabotage it finds a little less harmful (itch scratching, λ = .05 to .2: .73 to .75, from
    random weights .75 to 1). Ours."""
    sharing: Sharing | None = None
    """How many λ share a network; None: a network for each λ (the paper)."""
    ppo: PPOSettings = ALONE
    discriminator: DiscriminatorSettings = field(default_factory=DiscriminatorSettings)

    @property
    def search_measure(self) -> Measure:
        """The measure that `measure` names."""
        return measure_named(self.measure, self.discriminator, self.penalty)
