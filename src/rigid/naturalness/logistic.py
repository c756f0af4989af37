"""Balanced logistic regression by a small network: its logit is the log-ratio of two laws."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Array, Float, Int

from rigid.policies.networks import MLP, apply_mlp

_BUCKET = 1024
"""Numbers of rows are rounded up to a multiple of this, so that a fault compiles nothing anew."""


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """How one network is fitted."""

    hidden: tuple[int, ...]
    """Empty for a linear judge."""
    learning_rate: float
    weight_decay: float
    minibatch: int
    """Rows of each class in a gradient step."""
    block: int
    """Gradient steps between two looks at the validation loss."""
    blocks: int
    """Looks; the parameters of the best one are kept."""


class Sample(NamedTuple):
    """Rows of one class, padded; the first `count` of them are real."""

    rows: Float[Array, "n d"]
    count: Int[Array, ""]  # type: ignore[assignment]  # Hides `tuple.count`, which nobody needs.


class Side(NamedTuple):
    """One class, by use."""

    train: Sample
    validation: Sample


def padded(rows: Float[np.ndarray, "n d"], bucket: int = _BUCKET) -> Sample:
    """`rows` with zeros behind them, up to a multiple of `bucket`."""
    missing = -len(rows) % bucket
    filled = np.pad(np.asarray(rows, dtype=np.float32), ((0, missing), (0, 0)))
    return Sample(jnp.asarray(filled), jnp.asarray(len(rows), jnp.int32))


class _Training(NamedTuple):
    network: MLP
    optimiser: optax.OptState


class _Selection(NamedTuple):
    training: _Training
    best: MLP
    best_loss: Float[Array, ""]


def fit(
    canonical: Side, adversary: Side, rng: np.random.Generator, recipe: Recipe
) -> tuple[MLP, float]:
    """Fits log q/p; keeps the best block on validation rows.

    Equal class masses make the logit the log-ratio itself, whatever the numbers of rows.

    Returns:
        The network, and its log-loss on the validation rows: log 2 for one that knows nothing.
    """
    sizes = (canonical.train.rows.shape[-1], *recipe.hidden, 1)
    start = [
        {"w": rng.normal(0, fan_in**-0.5, (fan_in, fan_out)), "b": np.zeros(fan_out)}
        for fan_in, fan_out in pairwise(sizes)
    ]
    network = jax.tree.map(lambda weights: jnp.asarray(weights, jnp.float32), start)
    # Drawn here, since generators inside would double the time of compilation.
    picks = [
        rng.integers(side.train.count, size=(recipe.blocks, recipe.block, recipe.minibatch))
        for side in (canonical, adversary)
    ]
    best, loss = _descend(network, canonical, adversary, *picks, recipe=recipe)
    return best, float(loss)


@partial(jax.jit, static_argnames="recipe")
def _descend(
    network: MLP,
    canonical: Side,
    adversary: Side,
    canonical_picks: Int[Array, "blocks block m"],
    adversary_picks: Int[Array, "blocks block m"],
    *,
    recipe: Recipe,
) -> tuple[MLP, Float[Array, ""]]:
    optimiser = optax.adamw(recipe.learning_rate, weight_decay=recipe.weight_decay)

    def step(carry: _Training, picks: tuple[Array, Array]) -> tuple[_Training, None]:
        network, state = carry
        batches = [
            Sample(side.train.rows[rows], jnp.asarray(recipe.minibatch, jnp.int32))
            for side, rows in zip((canonical, adversary), picks, strict=True)
        ]
        updates, state = optimiser.update(jax.grad(_loss)(network, *batches), state, network)
        return _Training(optax.apply_updates(network, updates), state), None

    def block(carry: _Selection, picks: tuple[Array, Array]) -> tuple[_Selection, None]:
        training, best, best_loss = carry
        training, _ = jax.lax.scan(step, training, picks)
        loss = _loss(training.network, canonical.validation, adversary.validation)
        better = loss < best_loss
        best = jax.tree.map(lambda new, old: jnp.where(better, new, old), training.network, best)
        return _Selection(training, best, jnp.minimum(loss, best_loss)), None

    start = _Selection(
        _Training(network, optimiser.init(network)), network, jnp.asarray(jnp.inf, jnp.float32)
    )
    end, _ = jax.lax.scan(block, start, (canonical_picks, adversary_picks))
    return end.best, end.best_loss


def logit(network: MLP, rows: Float[np.ndarray, "*n d"]) -> Float[np.ndarray, "*n"]:
    """What `network` says of each row; in NumPy, where new numbers of rows compile nothing."""
    for layer in network[:-1]:
        rows = np.tanh(rows @ np.asarray(layer["w"]) + np.asarray(layer["b"]))
    last = network[-1]
    return np.asarray((rows @ np.asarray(last["w"]) + np.asarray(last["b"]))[..., 0])


def _loss(network: MLP, canonical: Sample, adversary: Sample) -> Float[Array, ""]:
    return 0.5 * (_side_loss(network, canonical, 1.0) + _side_loss(network, adversary, -1.0))


def _side_loss(network: MLP, sample: Sample, sign: float) -> Float[Array, ""]:
    losses = jax.nn.softplus(sign * apply_mlp(network, sample.rows)[..., 0])
    real = jnp.arange(losses.shape[0]) < sample.count
    return jnp.where(real, losses, 0.0).sum() / sample.count
