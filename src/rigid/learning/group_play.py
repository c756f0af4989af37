"""Episodes of many adversaries at once: one set of worlds, one block of them for each adversary."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.standardise import canonical_scale, standardise
from rigid.policies.gaussian import (
    GaussianParameters,
    group_mean_action,
    history_windows,
    stack_history,
)
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task, World

_PHASES = ("train", "referee", "score", "canonical", "discriminators")


def phase_rng(seed: int, phase: str, number: int = 0) -> np.random.Generator:
    """The generator of one phase of a group's work; phases and iterations never share numbers."""
    return np.random.default_rng([seed, _PHASES.index(phase), number])


class Opponent(NamedTuple):
    """What stays frozen while adversaries train."""

    robot: Policy
    human: GaussianParameters
    """The synthetic human: start, architecture, observation scale and action noise."""
    canonical: Float[np.ndarray, "E T f"]
    """Features of the search's canonical episodes."""
    canonical_seeds: Int[np.ndarray, " E"]
    """Starts of those episodes. Adversaries train from the same ones, so that the discriminator
    cannot mistake a chance imbalance of a few dozen starts for a way of moving. Ours."""
    reward_std: float
    """Per-step standard deviation of canonical reward, σ_R."""


class Experience(NamedTuple):
    """Episodes as an adversary learns from them."""

    observation: Float[Array, "T N o"]
    action: Float[Array, "T N a"]
    reward: Float[Array, "T N"]
    """In units of σ_R."""
    weight: Float[Array, "T N"]
    """1, or 0 from the step on at which physics ran away."""
    features: Float[Array, "T N f"]
    """Standardised."""


class Played(NamedTuple):
    """One iteration of a group: G blocks of as many episodes."""

    experience: Experience
    returns: Float[np.ndarray, " GN"]
    success: Float[np.ndarray, " GN"]


def play_group(
    task: Task,
    world: World,
    policies: Sequence[GaussianParameters],
    opponent: Opponent,
    episodes: int,
    memory: int,
    rng: np.random.Generator,
) -> Played:
    """Plays `episodes` with each policy, from starts of the search's canonical episodes.

    Args:
        task: The task that made `world`.
        world: G · `episodes` worlds.
        policies: G of them; their episodes follow one another.
        opponent: What stays frozen.
        episodes: Of each policy.
        memory: Observations that the policies act on.
        rng: Draws starts and actions.
    """
    starts = np.resize(rng.permutation(opponent.canonical_seeds), episodes)
    found = play(
        task,
        world,
        np.tile(starts, len(policies)),
        policy_actor(opponent.robot, len(policies) * episodes, None),
        group_actor(policies, rng),
    )
    seen = (
        history_windows(found.human_observation, memory),
        found.human_action,
        found.reward / opponent.reward_std,
        found.weight,
        standardise(canonical_scale(opponent.canonical), found.features),
    )
    experience = Experience(*(jnp.asarray(rows) for rows in seen))
    return Played(experience, found.returns, found.summary.success)


def canonical_motion(opponent: Opponent) -> Float[Array, "E T f"]:
    """The search's canonical episodes, standardised."""
    scale = canonical_scale(opponent.canonical)
    rows = standardise(scale, opponent.canonical.reshape(-1, scale.mean.size))
    return jnp.asarray(rows.reshape(opponent.canonical.shape))


def group_actor(
    policies: Sequence[GaussianParameters], rng: np.random.Generator
) -> Callable[[Float[np.ndarray, "GN o"]], Float[np.ndarray, "GN a"]]:
    """Acts for G adversaries at once; their worlds follow one another in G equal blocks.

    For one set of episodes: an adversary with memory carries what it saw from step to step.
    """
    stacked: GaussianParameters = jax.tree.map(lambda *leaves: jnp.stack(leaves), *policies)
    std = np.exp(np.asarray(stacked.log_std))[:, None]
    width = policies[0].normaliser.mean.size
    past: np.ndarray | None = None

    def act(observation: np.ndarray) -> np.ndarray:
        nonlocal past
        rows, size = observation.shape
        if past is None:
            past = np.full((rows, width - size), np.nan, np.float32)
        window = stack_history(observation, past)
        past = window[:, : width - size]
        grouped = window.reshape(len(policies), -1, width)
        mean = np.asarray(group_mean_action(stacked, grouped))
        noise = rng.standard_normal(mean.shape, dtype=np.float32)
        return np.asarray(mean + std * noise).reshape(-1, mean.shape[-1])

    return act
