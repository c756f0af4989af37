"""Behaviour cloning: a Gaussian human that does what recorded people did.

The likelihood is that of a Gaussian whose ends are clipped (`rigid.learning.censored`). Episodes
are divided by people: a part trains, one stops the training and sets the standard deviation, and
one, which neither saw, says how good the clone is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Array, Float, Int

from rigid.learning.censored import calibrated, censored_log_likelihood, mean_likelihood
from rigid.policies.gaussian import GaussianParameters, init_gaussian, mean_action
from rigid.policies.networks import Normaliser


@dataclass(frozen=True, kw_only=True)
class CloningSettings:
    """How a human is cloned. All values ours."""

    hidden: tuple[int, ...] = (64, 64)
    learning_rate: float = 1e-3
    weight_decay: float = 1e-4
    minibatch: int = 512
    """Steps of a gradient step."""
    block: int = 100
    """Gradient steps between two looks at the held-out likelihood."""
    blocks: int = 100
    """Looks at most."""
    patience: int = 10
    """Looks without a gain, after which training stops."""
    least_std: float = 0.01
    """Adversaries keep the clone's noise, and without any they have nothing to search with."""
    validation: float = 0.2
    """Share of the episodes that stop the training and set the standard deviation."""
    test: float = 0.2
    """Share that only judges."""


class Parts(NamedTuple):
    """Numbers of episodes by use."""

    train: Int[np.ndarray, " n"]
    validation: Int[np.ndarray, " m"]
    test: Int[np.ndarray, " k"]
    by: str
    """What is whole in a part: `participant` or `episode`."""


class Pairs(NamedTuple):
    """What was seen and what was done, n steps."""

    seen: Float[Array, "n o"]
    done: Float[Array, "n a"]


class Progress(NamedTuple):
    """A look at the held-out episodes."""

    look: int
    log_likelihood: float
    """Per step, on validation episodes."""


class Likelihoods(NamedTuple):
    """Mean log-likelihood of a step on test episodes; more is better."""

    clone: float
    mean_action: float
    """Of somebody who always does the mean of what was done."""
    last_action: float
    """Of somebody who does again what he just did."""


class _Training(NamedTuple):
    policy: tuple[list[dict[str, Array]], Float[Array, " a"]]
    optimiser: optax.OptState


def divide(
    episodes: int, participants: Sequence[str], settings: CloningSettings, seed: int
) -> Parts:
    """Divides episodes: all of a person into one part, where three people or more are known.

    Args:
        episodes: How many there are, at least 3.
        participants: Of each episode; empty texts where unknown.
        settings: The shares.
        seed: Of the draw.

    Raises:
        ValueError: There are fewer than 3.
    """
    if episodes < 3:
        raise ValueError(f"{episodes} episodes cannot be divided into three parts")
    people = sorted(set(participants))
    known = len(participants) == episodes and "" not in people and len(people) >= 3
    groups = np.array([people.index(p) for p in participants]) if known else np.arange(episodes)
    count = int(groups.max()) + 1
    order = np.random.default_rng([seed, 0]).permutation(count)
    sizes = [max(1, round(share * count)) for share in (settings.test, settings.validation)]
    held = np.split(order, np.cumsum(sizes))
    test, validation, train = (np.flatnonzero(np.isin(groups, part)) for part in held)
    return Parts(train, validation, test, "participant" if known else "episode")


def clone(
    train: Pairs,
    validation: Pairs,
    settings: CloningSettings,
    *,
    seed: int,
    report: Callable[[Progress], None] = lambda _: None,
) -> GaussianParameters:
    """A policy that does what was done, by the most likely one on held-out episodes.

    Args:
        train: To learn from.
        validation: To stop by, and to set the standard deviation by.
        settings: The recipe.
        seed: Everything random comes from it.
        report: Called after every look.
    """
    start = _start(train, settings, seed)
    optimiser = _optimiser(settings)
    free = start.network, start.log_std
    training = _Training(free, optimiser.init(free))
    rng = np.random.default_rng([seed, 1])
    best, best_likelihood, since = start, -np.inf, 0
    for look in range(settings.blocks):
        picks = rng.integers(len(train.seen), size=(settings.block, settings.minibatch))
        training = _descend(training, start.normaliser, train, jnp.asarray(picks), settings)
        network, log_std = training.policy
        policy = GaussianParameters(network, log_std, start.normaliser)
        likelihood = log_likelihood(policy, validation)
        report(Progress(look, likelihood))
        since += 1
        if likelihood > best_likelihood:
            best, best_likelihood, since = policy, likelihood, 0
        if since >= settings.patience:
            break
    log_std = calibrated(_mean(best, validation), np.asarray(validation.done), settings.least_std)
    return best._replace(log_std=jnp.asarray(log_std, jnp.float32))


def _start(train: Pairs, settings: CloningSettings, seed: int) -> GaussianParameters:
    seen, done = train
    policy = init_gaussian(
        jax.random.key(seed), seen.shape[1], done.shape[1], settings.hidden, std=1.0
    )
    count = jnp.asarray(len(seen), jnp.float32)
    log_std = jnp.log(jnp.maximum(done.std(axis=0), settings.least_std))
    normaliser = Normaliser(seen.mean(axis=0), seen.var(axis=0), count)
    return policy._replace(log_std=log_std, normaliser=normaliser)


def log_likelihood(policy: GaussianParameters, pairs: Pairs) -> float:
    """Mean log-likelihood of a step."""
    return mean_likelihood(_mean(policy, pairs), np.asarray(policy.log_std), np.asarray(pairs.done))


def compare(
    policy: GaussianParameters,
    train: Pairs,
    test: Pairs,
    steps: int,
    settings: CloningSettings,
) -> Likelihoods:
    """The clone beside two who look at nothing; their noise is set on the training episodes.

    Args:
        policy: The clone.
        train: Whole episodes, one after the other.
        test: The same.
        steps: Of an episode.
        settings: The least standard deviation.
    """
    known, asked = np.asarray(train.done), np.asarray(test.done)
    average = known.mean(axis=0)

    def constant(done: np.ndarray) -> np.ndarray:
        return np.broadcast_to(average, done.shape)

    def again(done: np.ndarray) -> np.ndarray:
        before = done.reshape(-1, steps, done.shape[1])[:, :-1]
        first = np.broadcast_to(average, (len(before), 1, done.shape[1]))
        return np.concatenate([first, before], axis=1).reshape(done.shape)

    found = [
        mean_likelihood(guess(asked), calibrated(guess(known), known, settings.least_std), asked)
        for guess in (constant, again)
    ]
    return Likelihoods(log_likelihood(policy, test), *found)


_jitted_mean = jax.jit(mean_action)


def _mean(policy: GaussianParameters, pairs: Pairs) -> Float[np.ndarray, "n a"]:
    return np.asarray(_jitted_mean(policy, pairs.seen), dtype=np.float64)


def _optimiser(settings: CloningSettings) -> optax.GradientTransformation:
    return optax.adamw(settings.learning_rate, weight_decay=settings.weight_decay)


@partial(jax.jit, static_argnames="settings")
def _descend(
    training: _Training,
    normaliser: Normaliser,
    pairs: Pairs,
    picks: Int[Array, "block m"],
    settings: CloningSettings,
) -> _Training:
    optimiser = _optimiser(settings)

    def loss(policy: tuple[list[dict[str, Array]], Array], rows: Array) -> Array:
        network, log_std = policy
        mean = mean_action(GaussianParameters(network, log_std, normaliser), pairs.seen[rows])
        likely = censored_log_likelihood(mean, log_std, pairs.done[rows])
        return -likely.sum(axis=-1).mean()

    def step(carry: _Training, rows: Array) -> tuple[_Training, None]:
        updates, state = optimiser.update(
            jax.grad(loss)(carry.policy, rows), carry.optimiser, carry.policy
        )
        return _Training(optax.apply_updates(carry.policy, updates), state), None

    return jax.lax.scan(step, training, picks)[0]
