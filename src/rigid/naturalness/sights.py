"""What a discriminator sees when it scores a step: that step, the last 16, or all steps so far.

A sight says which samples it learns from, and scores every step of an episode. Past steps tell what
single ones cannot: pauses, hesitation, the order of things.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, runtime_checkable

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.naturalness.lsgan import Network, score
from rigid.policies.networks import Layer, apply_mlp, init_mlp

WINDOW = 16
"""Steps of a window, 1.6 s of itch scratching: the length of the referee's windows. Ours."""


@runtime_checkable
class Sight(Protocol):
    """One way to look at motion; hashable."""

    keeps_episodes: ClassVar[bool]
    """Whether whole episodes are remembered, or steps."""
    learns_episodes: ClassVar[bool]
    """Whether a gradient step learns from whole episodes, or from a sample for each step."""

    def init(self, key: PRNGKeyArray, feature_size: int, hidden: Sequence[int]) -> Network:
        """A random network."""
        ...

    def judge(self, network: Network, samples: Float[Array, "*n"]) -> Float[Array, "*m"]:
        """Scores of samples."""
        ...

    def scores(self, network: Network, features: Float[Array, "T N f"]) -> Float[Array, "T N"]:
        """Score of every step of N episodes."""
        ...

    def canonical(self, canonical: Float[Array, "E T f"]) -> Float[Array, "n *unit"]:
        """Steps or episodes of canonical motion."""
        ...

    def units(
        self,
        features: Float[Array, "T N f"],
        weight: Float[Array, "T N"],
        canonical: Float[Array, "E T f"],
    ) -> Float[Array, "n *unit"]:
        """Steps or episodes of an adversary; canonical ones stand in for what a fault spoilt."""
        ...

    def samples(self, units: Float[Array, "n *unit"]) -> Float[Array, "m *sample"]:
        """What a gradient step learns from."""
        ...


@dataclass(frozen=True)
class Steps:
    """Single steps, as in the paper."""

    keeps_episodes: ClassVar[bool] = False
    learns_episodes: ClassVar[bool] = False

    def init(self, key: PRNGKeyArray, feature_size: int, hidden: Sequence[int]) -> Network:
        """A tanh network."""
        return init_mlp(key, (feature_size, *hidden, 1))

    def judge(self, network: Network, samples: Float[Array, "*n f"]) -> Float[Array, "*n"]:
        """A score for each row."""
        return score(network, samples)

    def scores(self, network: Network, features: Float[Array, "T N f"]) -> Float[Array, "T N"]:
        """A score for each step."""
        return score(network, features)

    def canonical(self, canonical: Float[Array, "E T f"]) -> Float[Array, "n f"]:
        """Every step."""
        return canonical.reshape(-1, canonical.shape[-1])

    def units(
        self,
        features: Float[Array, "T N f"],
        weight: Float[Array, "T N"],
        canonical: Float[Array, "E T f"],
    ) -> Float[Array, "n f"]:
        """Every step; canonical ones stand in for those after a fault."""
        sound = weight.reshape(-1, 1) > 0
        rows = self.canonical(canonical)
        filler = rows[jnp.arange(sound.shape[0]) % rows.shape[0]]
        return jnp.where(sound, features.reshape(sound.shape[0], -1), filler)

    def samples(self, units: Float[Array, "n f"]) -> Float[Array, "n f"]:
        """The steps themselves."""
        return units


class _WholeEpisodes:
    """Of sights that need a past: an episode is remembered or, after a fault, left out whole."""

    keeps_episodes: ClassVar[bool] = True

    def canonical(self, canonical: Float[Array, "E T f"]) -> Float[Array, "E T f"]:
        """Every episode."""
        return canonical

    def units(
        self,
        features: Float[Array, "T N f"],
        weight: Float[Array, "T N"],
        canonical: Float[Array, "E T f"],
    ) -> Float[Array, "N T f"]:
        """Every episode; canonical ones stand in for those with a fault."""
        sound = weight[-1] > 0
        filler = canonical[jnp.arange(sound.shape[0]) % canonical.shape[0]]
        return jnp.where(sound[:, None, None], features.swapaxes(0, 1), filler)


@dataclass(frozen=True)
class Windows(_WholeEpisodes):
    """The last `length` steps; before an episode's beginning its first step is repeated."""

    learns_episodes: ClassVar[bool] = False
    length: int = WINDOW

    def init(self, key: PRNGKeyArray, feature_size: int, hidden: Sequence[int]) -> Network:
        """A tanh network that sees every number of the window."""
        return init_mlp(key, (self.length * feature_size, *hidden, 1))

    def judge(self, network: Network, samples: Float[Array, "*n d"]) -> Float[Array, "*n"]:
        """A score for each window."""
        return score(network, samples)

    def scores(self, network: Network, features: Float[Array, "T N f"]) -> Float[Array, "T N"]:
        """A score for the window that ends at each step."""
        return score(network, last_steps(features.swapaxes(0, 1), self.length)).T

    def samples(self, units: Float[Array, "N T f"]) -> Float[Array, "n d"]:
        """The window that ends at each step."""
        seen = last_steps(units, self.length)
        return seen.reshape(-1, seen.shape[-1])


@dataclass(frozen=True)
class Recurrent(_WholeEpisodes):
    """All steps so far, through a gated recurrent unit (Cho et al., 2014) of `size` numbers."""

    learns_episodes: ClassVar[bool] = True
    size: int = 32
    """Ours."""

    def init(self, key: PRNGKeyArray, feature_size: int, hidden: Sequence[int]) -> Network:
        """A random cell, and the layers that read its state."""
        keys = jax.random.split(key, 3)
        orthogonal = jax.nn.initializers.orthogonal()
        return {
            "input": _layer(orthogonal(keys[0], (feature_size, 3 * self.size), jnp.float32)),
            "state": _layer(orthogonal(keys[1], (self.size, 3 * self.size), jnp.float32)),
            "output": init_mlp(keys[2], (self.size, *hidden[1:], 1)),
        }

    def judge(self, network: Network, samples: Float[Array, "*n T f"]) -> Float[Array, "*n T"]:
        """A score for each step of each episode."""
        given = _affine(network["input"], jnp.moveaxis(samples, -2, 0))

        def step(state: Array, seen: Array) -> tuple[Array, Array]:
            held = _affine(network["state"], state)
            (reset, update, new), (reset_, update_, new_) = (
                jnp.split(both, 3, axis=-1) for both in (seen, held)
            )
            gate = jax.nn.sigmoid(update + update_)
            fresh = jnp.tanh(new + jax.nn.sigmoid(reset + reset_) * new_)
            state = gate * state + (1 - gate) * fresh
            return state, state

        empty = jnp.zeros((*given.shape[1:-1], self.size), given.dtype)
        _, states = jax.lax.scan(step, empty, given, unroll=4)
        return jnp.moveaxis(apply_mlp(network["output"], states)[..., 0], 0, -1)

    def scores(self, network: Network, features: Float[Array, "T N f"]) -> Float[Array, "T N"]:
        """A score for each step."""
        return self.judge(network, features.swapaxes(0, 1)).T

    def samples(self, units: Float[Array, "N T f"]) -> Float[Array, "N T f"]:
        """Whole episodes."""
        return units


def last_steps(features: Float[Array, "N T f"], length: int) -> Float[Array, "N T d"]:
    """The `length` steps up to each one, oldest first, side by side; the first is repeated.

    Example:
        >>> last_steps(jnp.arange(4.0).reshape(1, 4, 1), 3)[0]
        Array([[0., 0., 0.],
               [0., 0., 1.],
               [0., 1., 2.],
               [1., 2., 3.]], dtype=float32)
    """
    steps = jnp.arange(features.shape[1])
    ages = range(length - 1, -1, -1)
    return jnp.concatenate([features[:, jnp.maximum(steps - age, 0)] for age in ages], axis=-1)


def _layer(weights: Float[Array, "i o"]) -> Layer:
    return {"w": weights, "b": jnp.zeros(weights.shape[1])}


def _affine(layer: Layer, x: Float[Array, "*n i"]) -> Float[Array, "*n o"]:
    product = x @ layer["w"]
    return product + jnp.broadcast_to(layer["b"], product.shape)
