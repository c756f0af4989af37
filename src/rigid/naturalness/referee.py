"""The held-out judge of naturalness: one recipe for every adversary, never the one it trained with.

For each adversary the referee estimates its own log-ratio log q/p between the adversary's law q of
the features and the canonical law p, by logistic regression with a small network. Pooling several
adversaries into one class would judge their mixture instead. Naturalness is the hockey-stick
overlap of the two laws, estimated on episodes that neither training nor validation saw:

    x_κ = min(1, P_q[f < 0] + κ P_p[f ≥ 0]),   f = log(q/p) - log κ.

For any fixed f its expectation before clipping is at least the true overlap ∫ min(q, κ p): a weak
referee errs towards natural, never towards unnatural. κ = 4 is the paper's class weight.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.naturalness.standardise import Scale, standardise
from rigid.policies.networks import MLP, apply_mlp, init_mlp

HEADLINE_KAPPA = 4.0
"""The x axis: class weight of the paper's discriminator (appendix 'Improving GAN training')."""
KAPPAS = (1.0, HEADLINE_KAPPA)


@dataclass(frozen=True, kw_only=True)
class RefereeSettings:
    """One recipe for every adversary, robot and run of a task. All values ours."""

    hidden: tuple[int, ...] = (64, 64)
    learning_rate: float = 2e-3
    weight_decay: float = 1e-4
    minibatch: int = 512
    """Rows of each class in a gradient step."""
    block: int = 50
    """Gradient steps between two looks at the validation loss."""
    blocks: int = 16
    """Looks; the parameters of the best one are kept."""


class Referee(NamedTuple):
    """A trained judge of one adversary."""

    network: MLP
    scale: Scale


class Rows(NamedTuple):
    """Features of one class, by use; each (n, f) and in the task's own units."""

    train: Float[np.ndarray, "n f"]
    validation: Float[np.ndarray, "m f"]


def train_referee(
    canonical: Rows,
    adversary: Rows,
    scale: Scale,
    settings: RefereeSettings,
    key: PRNGKeyArray,
) -> Referee:
    """Fits log q/p by balanced logistic regression; keeps the best block on validation rows.

    Equal class masses make the logit the log-ratio itself, whatever the numbers of rows.

    Raises:
        ValueError: The two sides have different numbers of features.
    """
    if canonical.train.shape[-1] != adversary.train.shape[-1]:
        raise ValueError(
            f"canonical rows have {canonical.train.shape[-1]} features, "
            f"the adversary's {adversary.train.shape[-1]}"
        )
    natural, other = (
        [jnp.asarray(standardise(scale, rows), jnp.float32) for rows in side]
        for side in (canonical, adversary)
    )
    return Referee(_fit(*natural, *other, key, settings=settings), scale)


def log_ratio(referee: Referee, features: Float[np.ndarray, "*n f"]) -> Float[np.ndarray, "*n"]:
    """Estimated log q/p of each row; negative where canonical motion is the likelier source."""
    rows = standardise(referee.scale, np.asarray(features, dtype=np.float32))
    return np.asarray(_logit(referee.network, rows))


def overlap(
    adversary: Float[np.ndarray, "*n"], canonical: Float[np.ndarray, "*m"], kappa: float
) -> float:
    """Naturalness from held-out log-ratios: the share that cannot be told from κ times canonical.

    Args:
        adversary: log q/p on the adversary's held-out rows.
        canonical: log q/p on canonical held-out rows.
        kappa: How many times over canonical behaviour may be replayed; κ = 4 still calls an
            adversary natural that repeats the worst quarter of canonical behaviour.

    Example:
        >>> overlap(np.array([-1.0, 1.0, 2.0, 3.0]), np.array([-1.0, -2.0, -3.0, -4.0]), 4.0)
        0.5
    """
    threshold = np.log(kappa)
    passed = float(np.mean(np.asarray(adversary) < threshold))
    alarms = float(np.mean(np.asarray(canonical) >= threshold))
    return min(1.0, passed + kappa * alarms)


class _Training(NamedTuple):
    network: MLP
    optimiser: optax.OptState


class _Selection(NamedTuple):
    training: _Training
    best: MLP
    best_loss: Float[Array, ""]


@jax.jit
def _logit(network: MLP, rows: Float[Array, "*n f"]) -> Float[Array, "*n"]:
    return apply_mlp(network, rows)[..., 0]


def _loss(
    network: MLP, canonical: Float[Array, "n f"], adversary: Float[Array, "m f"]
) -> Float[Array, ""]:
    low, high = apply_mlp(network, canonical)[..., 0], apply_mlp(network, adversary)[..., 0]
    return 0.5 * (jax.nn.softplus(low).mean() + jax.nn.softplus(-high).mean())


@partial(jax.jit, static_argnames="settings")
def _fit(
    canonical: Float[Array, "n f"],
    canonical_validation: Float[Array, "m f"],
    adversary: Float[Array, "k f"],
    adversary_validation: Float[Array, "l f"],
    key: PRNGKeyArray,
    *,
    settings: RefereeSettings,
) -> MLP:
    optimiser = optax.adamw(settings.learning_rate, weight_decay=settings.weight_decay)
    init_key, run_key = jax.random.split(key)
    network = init_mlp(init_key, (canonical.shape[-1], *settings.hidden, 1), last_scale=0.1)

    def step(carry: _Training, step_key: Array) -> tuple[_Training, None]:
        network, state = carry
        keys = jax.random.split(step_key)
        batches = [
            rows[jax.random.randint(k, (settings.minibatch,), 0, rows.shape[0])]
            for k, rows in zip(keys, (canonical, adversary), strict=True)
        ]
        updates, state = optimiser.update(jax.grad(_loss)(network, *batches), state, network)
        return _Training(optax.apply_updates(network, updates), state), None

    def block(carry: _Selection, block_key: Array) -> tuple[_Selection, None]:
        training, best, best_loss = carry
        keys = jax.random.split(block_key, settings.block)
        training, _ = jax.lax.scan(step, training, keys)
        loss = _loss(training.network, canonical_validation, adversary_validation)
        better = loss < best_loss
        best = jax.tree.map(lambda new, old: jnp.where(better, new, old), training.network, best)
        return _Selection(training, best, jnp.minimum(loss, best_loss)), None

    start = _Selection(
        _Training(network, optimiser.init(network)), network, jnp.asarray(jnp.inf, jnp.float32)
    )
    end, _ = jax.lax.scan(block, start, jax.random.split(run_key, settings.blocks))
    return end.best
