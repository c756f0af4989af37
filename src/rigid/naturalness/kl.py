"""KL divergence from the synthetic human, exact: its density and the adversary's are both known.

The dynamics cancel in log q(τ) / p(τ), so that it is the sum over steps of

    log π̃(a | o) - log π_H(a | o),

whose mean under the adversary is the KL divergence. It is in nats per step; its unit is 1. It sees
the actions and not what they lead to, so that it also charges for differences that nobody could see
in the motion. The paper estimates the same quantity by a logistic discriminator (appendix 'Proof on
Discriminator and KL Divergence'): measure `kl-gan`.
"""

from __future__ import annotations

from dataclasses import dataclass

import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.naturalness.measure import Health, Motion, unknown
from rigid.policies.gaussian import GaussianParameters, log_density, mean_action


@dataclass(frozen=True)
class ExactKL:
    """The log-ratio of the sampled actions; its state is the synthetic human."""

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> GaussianParameters:
        """Nothing is learned."""
        del key, canonical
        return human

    def unit(self, state: GaussianParameters, canonical: Float[Array, "E T f"]) -> Float[Array, ""]:
        """1 nat."""
        del state, canonical
        return jnp.ones(())

    def penalty(
        self,
        state: GaussianParameters,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "T N"]:
        """Log-ratio of each action [nat]."""
        del canonical
        return log_ratio(policy, state, motion.observation, motion.action)

    def score(self, state: GaussianParameters, features: Float[Array, "T N f"]) -> None:
        """There is no classifier."""
        del state, features

    def update(
        self,
        state: GaussianParameters,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[GaussianParameters, Health]:
        """Nothing to learn; the loss is the estimated divergence [nat per step]."""
        del iteration, keys
        ratio = self.penalty(state, canonical, motion, policy)
        weight = motion.weight
        divergence = (ratio * weight).sum() / jnp.maximum(weight.sum(), 1.0)
        return state, Health(divergence, unknown(), unknown(), unknown(), unknown())

    def kept(self, state: GaussianParameters) -> None:
        """Nothing: the human lies elsewhere."""
        del state

    def score_kept(self, kept: None, features: Float[Array, "T N f"]) -> None:
        """There is no classifier."""
        del kept, features


def log_ratio(
    adversary: GaussianParameters,
    human: GaussianParameters,
    observation: Float[Array, "*n o"],
    action: Float[Array, "*n a"],
) -> Float[Array, "*n"]:
    """Log-ratio π̃(a | o) over π_H(a | o) of unclipped actions [nat]."""
    theirs, ours = (
        log_density(mean_action(policy, observation), policy.log_std, action)
        for policy in (adversary, human)
    )
    return theirs - ours
