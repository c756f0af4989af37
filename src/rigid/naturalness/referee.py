"""The held-out judge of naturalness: one recipe for every adversary, never the one it trained with.

For each adversary the referee estimates its own log-ratio log q/p between the adversary's law q of
the features and the canonical law p, by logistic regression. Pooling several adversaries into one
class would judge their mixture instead. Naturalness is the hockey-stick overlap of the two laws,
estimated on episodes that neither training nor validation saw:

    x_κ = min(1, P_q[f < 0] + κ P_p[f ≥ 0]),   f = log(q/p) - log κ.

For any fixed f its expectation before clipping is at least the true overlap ∫ min(q, κ p): a weak
referee errs towards natural, never towards unnatural. κ = 4 is the paper's class weight.

A referee is one of a small family, the member with the least log-loss on validation rows: a network
and a linear judge for single steps; a network on the whole window and a linear judge of the
window's summary for 16-step windows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float, PRNGKeyArray

from rigid.naturalness.logistic import Recipe, Side, fit, logit, padded
from rigid.naturalness.standardise import Scale, standardise
from rigid.naturalness.views import VIEWS
from rigid.policies.networks import MLP

HEADLINE_KAPPA = 4.0
"""The x axis: class weight of the paper's discriminator (appendix 'Improving GAN training')."""


@dataclass(frozen=True, kw_only=True)
class RefereeSettings:
    """One recipe for every adversary, robot and run of a task. All values ours."""

    hidden: tuple[int, ...] = (64, 64)
    """Of the network that sees single steps."""
    window_hidden: tuple[int, ...] = (32,)
    """Of the network that sees whole windows: few, since windows of an episode overlap."""
    learning_rate: float = 2e-3
    weight_decay: float = 1e-4
    minibatch: int = 512
    """Steps of each class in a gradient step."""
    window_minibatch: int = 128
    """Windows of each class in a gradient step."""
    block: int = 50
    """Gradient steps between two looks at the validation loss."""
    blocks: int = 16
    """Looks; the parameters of the best one are kept."""
    folds: int = 4
    """Of recorded episodes: a half trains, a quarter validates and a quarter tests at a time."""

    def members(self, length: int) -> tuple[Member, ...]:
        """The family that judges windows of `length` steps."""
        if length == 1:
            hidden, minibatch, linear = self.hidden, self.minibatch, "flat"
        else:
            hidden, minibatch, linear = self.window_hidden, self.window_minibatch, "summary"
        recipe = Recipe(
            hidden=hidden, learning_rate=self.learning_rate, weight_decay=self.weight_decay,
            minibatch=minibatch, block=self.block, blocks=self.blocks,
        )  # fmt: skip
        return Member("flat", recipe), Member(linear, replace(recipe, hidden=()))


class Member(NamedTuple):
    """One of the family: what it sees, and how it is fitted."""

    view: str
    recipe: Recipe


class Referee(NamedTuple):
    """A trained judge of one adversary."""

    network: MLP
    scale: Scale
    """Of the network's input."""
    length: int = 1
    """Steps of the windows that it judges; 1 for single steps."""
    view: str = "flat"
    """How such a window becomes the input."""


class Rows(NamedTuple):
    """Features of one class, by use, in the task's own units; a row for each step."""

    train: Float[np.ndarray, "n f"]
    validation: Float[np.ndarray, "m f"]


def train_referee(
    canonical: Rows,
    adversary: Rows,
    scale: Scale,
    settings: RefereeSettings,
    key: PRNGKeyArray,
) -> Referee:
    """A referee of single steps: of its family the one with the least validation loss.

    Raises:
        ValueError: The two sides have different numbers of features.
    """
    if canonical.train.shape[-1] != adversary.train.shape[-1]:
        raise ValueError(
            f"canonical rows have {canonical.train.shape[-1]} features, "
            f"the adversary's {adversary.train.shape[-1]}"
        )
    natural, other = (
        Side(*(padded(standardise(scale, rows)) for rows in side))
        for side in (canonical, adversary)
    )
    return least_loss([
        fit_member(Referee([], scale), member, natural, other, key)
        for member in settings.members(1)
    ])  # fmt: skip


def fit_member(
    blank: Referee, member: Member, canonical: Side, adversary: Side, key: PRNGKeyArray
) -> tuple[Referee, float]:
    """A member of the family and its validation loss.

    Args:
        blank: The referee without its network.
        member: How to fit it.
        canonical: Inputs of canonical motion, standardised.
        adversary: Those of the adversary.
        key: Consumed.
    """
    rng = np.random.default_rng(np.asarray(jax.random.key_data(key)))
    network, loss = fit(canonical, adversary, rng, member.recipe)
    return blank._replace(network=network), loss


def least_loss(fitted: Sequence[tuple[Referee, float]]) -> Referee:
    """The best of a family."""
    return min(fitted, key=lambda found: found[1])[0]


def log_ratio(referee: Referee, features: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """Estimated log q/p of each row; negative where canonical motion is the likelier source.

    Args:
        referee: A judge of single steps or of windows.
        features: (…, f) for the one, (…, L, f) for the other, in the task's own units.

    Returns:
        A number for each row or window, (…).
    """
    rows = np.asarray(features, dtype=np.float32)
    if referee.length > 1:
        rows = VIEWS[referee.view](rows)
    return logit(referee.network, standardise(referee.scale, rows))


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
