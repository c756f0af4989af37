"""Measures that train a discriminator against each adversary (paper, Eq. 2 and appendix on KL)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.naturalness.lsgan import (
    PENALTIES,
    Discriminator,
    DiscriminatorSettings,
    Loss,
    Network,
    noise_level,
    update_discriminator,
    with_optimiser,
)
from rigid.naturalness.measure import Health, Motion
from rigid.naturalness.sights import Sight, Steps
from rigid.policies.gaussian import GaussianParameters

REPLAY_ROWS = 256
"""Steps remembered of each iteration (ours)."""
_LEAST_EPISODES = 4
"""Of each class in a gradient step that learns from whole episodes: a quarter of them is old."""


class GanState(NamedTuple):
    """A discriminator in training and what it remembers."""

    discriminator: Discriminator
    replay: Float[Array, "R *unit"]
    """Standardised features of the last iterations."""


@dataclass(frozen=True, kw_only=True)
class Gan:
    """A discriminator between canonical and adversarial motion; the default measure.

    The penalty is a function of its score D: `amp` ¼ max(D + 1, 0)², `paper_d2` D², each over its
    deviation on canonical motion before training; `log_ratio` D + log κ, an estimate of log q/p in
    nats per step, whose unit is 1 nat.
    """

    settings: DiscriminatorSettings = field(default_factory=DiscriminatorSettings)
    penalised: str = "amp"
    loss: Loss = "least_squares"
    sight: Sight = field(default_factory=Steps)

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> GanState:
        """A random discriminator and an empty replay."""
        del human
        network = self.sight.init(key, canonical.shape[-1], self.settings.hidden)
        one = self.sight.canonical(canonical)[0]
        rows = self.settings.replay_iterations * self._kept(canonical)
        return GanState(with_optimiser(network, self.settings), jnp.zeros((rows, *one.shape)))

    def unit(self, state: GanState, canonical: Float[Array, "E T f"]) -> Float[Array, ""]:
        """Deviation of the penalty on canonical motion; 1 nat for a log-ratio."""
        if self.penalised == "log_ratio":
            return jnp.ones(())
        samples = self.sight.samples(self.sight.canonical(canonical))
        scores = self.sight.judge(state.discriminator.network, samples)
        return jnp.maximum(self._of(scores).std(), 1e-3)

    def penalty(
        self,
        state: GanState,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "T N"]:
        """A function of the scores."""
        del policy, canonical
        return self._of(self.score(state, motion.features))

    def score(self, state: GanState, features: Float[Array, "T N f"]) -> Float[Array, "T N"]:
        """D of every step, noise off."""
        return self.score_kept(self.kept(state), features)

    def update(
        self,
        state: GanState,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[GanState, Health]:
        """Gradient steps on this iteration's motion and on what is remembered."""
        del policy
        units = self.sight.units(motion.features, motion.weight, canonical)
        replay = remember(state.replay, units, iteration, keys[1], self._kept(canonical))
        own, current, old = (
            self.sight.samples(each) for each in (self.sight.canonical(canonical), units, replay)
        )
        noise = noise_level(iteration.astype(jnp.float32), self.settings)
        discriminator, health = update_discriminator(
            state.discriminator, own, current, old, noise, keys[0], self._training(canonical),
            judge=self.sight.judge, loss=self.loss,
        )  # fmt: skip
        return GanState(discriminator, replay), health

    def kept(self, state: GanState) -> Network:
        """The network."""
        return state.discriminator.network

    def score_kept(self, kept: Network, features: Float[Array, "T N f"]) -> Float[Array, "T N"]:
        """D of every step, noise off."""
        return self.sight.scores(kept, features)

    def _of(self, scores: Float[Array, "*n"]) -> Float[Array, "*n"]:
        if self.penalised == "log_ratio":
            settings = self.settings
            return scores + math.log(settings.canonical_weight / settings.adversary_weight)
        return PENALTIES[self.penalised](scores)

    def _kept(self, canonical: Float[Array, "E T f"]) -> int:
        """Steps or episodes remembered of each iteration."""
        whole = max(REPLAY_ROWS // canonical.shape[1], 1)
        return whole if self.sight.keeps_episodes else REPLAY_ROWS

    def _training(self, canonical: Float[Array, "E T f"]) -> DiscriminatorSettings:
        """Minibatches of about as many steps, where episodes are learned from as well."""
        if not self.sight.learns_episodes:
            return self.settings
        episodes = max(self.settings.minibatch // canonical.shape[1], _LEAST_EPISODES)
        return replace(self.settings, minibatch=episodes)


def remember(
    replay: Float[Array, "R *unit"],
    units: Float[Array, "n *unit"],
    iteration: Int[Array, ""],
    key: PRNGKeyArray,
    kept: int,
) -> Float[Array, "R *unit"]:
    """The replay with `kept` of this iteration's units in place of the oldest.

    The first iteration fills it all.
    """
    drawn = units[jax.random.randint(key, replay.shape[:1], 0, units.shape[0])]
    slot = jnp.arange(replay.shape[0]) // kept
    mine = slot == iteration % (replay.shape[0] // kept)
    chosen = ((iteration == 0) | mine).reshape(-1, *(1 for _ in units.shape[1:]))
    return jnp.where(chosen, drawn, replay)
