"""Natural-adversarial humans: PPO against a frozen robot, held close by a search measure.

For a weight λ the adversary maximises, per step,

    -R / σ_R - λ · penalty / σ_P            (paper, Eq. 6; by default with Eq. 2's D)

σ_R is the per-step standard deviation of canonical reward, σ_P the measure's unit, by default the
deviation of the penalty on canonical motion before training; both are frozen. λ = ∞ drops the first
term. A group of adversaries, one for each λ, plays side by side in one set of worlds; each then
learns on its own rows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, PRNGKeyArray, Shaped

from rigid.learning.ppo import Learner, PPOSettings, Rollout, ppo_update, start_learner
from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.choice import DEFAULT_MEASURE, measure_named
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.measure import Health, Measure, Motion, unknown
from rigid.naturalness.standardise import canonical_scale, standardise
from rigid.policies.gaussian import (
    GaussianParameters,
    group_mean_action,
    history_windows,
    stack_history,
    with_memory,
)
from rigid.policies.networks import init_mlp
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task, World


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
    ppo: PPOSettings = field(
        default_factory=lambda: PPOSettings(
            learning_rate=5e-4, minibatch=1200, update_normaliser=False, signal_floor=0.3
        )
    )
    """The paper does not give the adversary's PPO settings. Ours."""
    discriminator: DiscriminatorSettings = field(default_factory=DiscriminatorSettings)

    @property
    def search_measure(self) -> Measure:
        """The measure that `measure` names."""
        return measure_named(self.measure, self.discriminator, self.penalty)


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


class Adversary(NamedTuple):
    """One adversary in training; a pytree, so that it can be saved at any iteration."""

    learner: Learner
    measure: Any
    """State of the search measure; of a discriminator it is a `GanState`."""
    penalty_std: Float[Array, ""]
    """σ_P, frozen."""
    lambda_: Float[Array, ""]
    iteration: Int[Array, ""]


class Experience(NamedTuple):
    """The episodes of one adversary in one iteration."""

    observation: Float[Array, "T N o"]
    action: Float[Array, "T N a"]
    reward: Float[Array, "T N"]
    """In units of σ_R."""
    weight: Float[Array, "T N"]
    """1, or 0 from the step on at which physics ran away."""
    features: Float[Array, "T N f"]
    """Standardised."""


class Metrics(NamedTuple):
    """What one iteration saw."""

    mean_return: Float[Array, ""]
    success: Float[Array, ""]
    penalty: Float[Array, ""]
    naturalness_own: Float[Array, ""]
    """Share of steps that its own discriminator takes for canonical; NaN where it has none."""
    entropy: Float[Array, ""]
    health: Health


_PHASES = ("train", "referee", "score", "canonical", "discriminators")


def phase_rng(seed: int, phase: str, number: int = 0) -> np.random.Generator:
    """The generator of one phase of a group's work; phases and iterations never share numbers."""
    return np.random.default_rng([seed, _PHASES.index(phase), number])


def start_adversary(
    opponent: Opponent, settings: AdversarySettings, lambda_: float, key: PRNGKeyArray
) -> Adversary:
    """A fresh adversary and its measure, before any step."""
    policy_key, critic_key, measure_key = jax.random.split(key, 3)
    canonical, measure = canonical_motion(opponent), settings.search_measure
    human = with_memory(opponent.human, settings.memory)
    sizes = [human.network[0]["w"].shape[0], *(layer["w"].shape[1] for layer in human.network)]
    state = measure.start(measure_key, canonical, human)
    if lambda_ < settings.natural_start:
        human = human._replace(network=init_mlp(policy_key, sizes, last_scale=0.01))
    critic = init_mlp(critic_key, (sizes[0] + 1, *sizes[1:-1], 1), last_scale=0.01)
    return Adversary(
        start_learner(settings.ppo, human, critic, human.normaliser),
        state,
        measure.unit(state, canonical),
        jnp.asarray(lambda_, jnp.float32),
        jnp.asarray(0, jnp.int32),
    )


def canonical_motion(opponent: Opponent) -> Float[Array, "E T f"]:
    """The search's canonical episodes, standardised."""
    scale = canonical_scale(opponent.canonical)
    rows = standardise(scale, opponent.canonical.reshape(-1, scale.mean.size))
    return jnp.asarray(rows.reshape(opponent.canonical.shape))


def own_scores(
    adversary: Adversary,
    features: Float[np.ndarray, "N T f"],
    opponent: Opponent,
    settings: AdversarySettings,
) -> Float[np.ndarray, "N T"] | None:
    """What an adversary's own discriminator says of episodes, low for canonical.

    None where its search measure has no classifier.
    """
    seen = standardise(canonical_scale(opponent.canonical), features).swapaxes(0, 1)
    scores = settings.search_measure.score(adversary.measure, jnp.asarray(seen))
    return None if scores is None else np.asarray(scores).T


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


def train_iteration(
    task: Task,
    world: World,
    group: Sequence[Adversary],
    opponent: Opponent,
    settings: AdversarySettings,
    seed: int,
) -> list[tuple[Adversary, Metrics]]:
    """One iteration of every adversary: play, one policy update, one update of its measure.

    All randomness comes from (`seed`, iteration), so a group that was saved between two iterations
    goes on as if it had never stopped.
    """
    iteration = int(group[0].iteration)
    rng = phase_rng(seed, "train", iteration)
    starts = np.resize(rng.permutation(opponent.canonical_seeds), settings.episodes)
    policies = [adversary.learner.policy for adversary in group]
    episodes = play(
        task,
        world,
        np.tile(starts, len(group)),
        policy_actor(opponent.robot, len(group) * settings.episodes, None),
        group_actor(policies, rng),
    )
    canonical = canonical_motion(opponent)
    features = standardise(canonical_scale(opponent.canonical), episodes.features)
    seen = history_windows(episodes.human_observation, settings.memory)
    key = jax.random.fold_in(jax.random.key(seed), iteration)
    results = []
    for index, adversary in enumerate(group):
        mine = slice(index * settings.episodes, (index + 1) * settings.episodes)
        own = (
            seen,
            episodes.human_action,
            episodes.reward / opponent.reward_std,
            episodes.weight,
            features,
        )
        experience = Experience(*(jnp.asarray(rows[:, mine]) for rows in own))
        updated, metrics = _update(
            adversary, experience, canonical, jax.random.fold_in(key, index), settings=settings
        )
        observed = metrics._replace(
            mean_return=episodes.returns[mine].mean(),
            success=np.mean(episodes.summary.success[mine]),
        )
        results.append((updated, observed))
    return results


@partial(jax.jit, static_argnames="settings")
def _update(
    adversary: Adversary,
    experience: Experience,
    canonical: Float[Array, "E T f"],
    key: PRNGKeyArray,
    *,
    settings: AdversarySettings,
) -> tuple[Adversary, Metrics]:
    observation, action, reward, weight, features = experience
    keys, measure = jax.random.split(key, 3), settings.search_measure
    motion, policy = Motion(features, weight, observation, action), adversary.learner.policy
    penalty = measure.penalty(adversary.measure, canonical, motion, policy)
    scores = measure.score(adversary.measure, features)
    rollout = Rollout(
        observation=observation,
        critic_observation=observation,
        action=action,
        reward=weight * shaped_reward(
            adversary.lambda_, reward, penalty / adversary.penalty_std
        ),
        weight=weight,
        expert_action=jnp.zeros_like(action),
    )  # fmt: skip
    pace = pace_at(adversary.iteration, settings.iterations)
    learner, losses = ppo_update(adversary.learner, rollout, keys[0], settings.ppo, pace)
    state, health = measure.update(
        adversary.measure, canonical, motion, policy, adversary.iteration, keys[1:]
    )
    metrics = Metrics(
        mean_return=jnp.zeros(()),
        success=jnp.zeros(()),
        penalty=_mean(penalty, weight),
        naturalness_own=unknown() if scores is None else _mean(scores < 0, weight),
        entropy=losses.entropy,
        health=health,
    )
    after = Adversary(
        learner, state, adversary.penalty_std, adversary.lambda_, adversary.iteration + 1
    )
    return after, metrics


def _mean(x: Shaped[Array, "T N"], weight: Float[Array, "T N"]) -> Float[Array, ""]:
    return (x * weight).sum() / jnp.maximum(weight.sum(), 1.0)


def pace_at(iteration: Int[Array, ""] | float, iterations: int) -> Float[Array, ""]:
    """Share of the learning rate: from 0 to 1 in three iterations, then linearly down to 0.

    Ours. A fresh critic would first push a policy that starts at the synthetic human away from it,
    and a constant rate would keep it wandering until the end.
    """
    rise = jnp.minimum(iteration / 3, 1.0)
    return rise * (1 - iteration / iterations)


def shaped_reward(
    lambda_: Float[Array, ""], reward: Float[Array, "T N"], penalty: Float[Array, "T N"]
) -> Float[Array, "T N"]:
    """What the adversary maximises per step; both streams in their own frozen unit.

    The common factor moves no optimum; it keeps the critic's targets near 1 for every λ.
    """
    only_natural = jnp.isinf(lambda_)
    task_weight = jnp.where(only_natural, 0.0, 1.0)
    natural_weight = jnp.where(only_natural, 1.0, lambda_)
    total = -task_weight * reward - natural_weight * penalty
    return 0.1 * total / (task_weight + natural_weight)
