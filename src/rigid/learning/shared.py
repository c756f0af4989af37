"""Adversaries that share a network: one policy learns for many λ at a time.

What one λ learns of the robot's weak places serves its neighbours, so that a group of them costs no
more for being dense. A family is one network; at each iteration it plays at as many λ of its range
as it has slots, and a code tells the network which is meant. Each slot has a search measure of its
own. There are two families (`Sharing`): one starts from random weights and explores loudly, one at
the synthetic human. Ours.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, PRNGKeyArray, Shaped

from rigid.learning.adversary import (
    Adversary,
    Metrics,
    first_networks,
    mean_of_sound,
    pace_at,
    rollout_of,
    seen_by_task,
    shaped_reward,
)
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.conditioned import CODE_SIZE, at_code, told
from rigid.learning.group_play import (
    Experience,
    Opponent,
    canonical_motion,
    phase_rng,
    play_group,
)
from rigid.learning.learner import Learner
from rigid.learning.ppo import ppo_update, start_learner
from rigid.learning.ranges import Drawn, Range, draw
from rigid.naturalness.measure import Motion, unknown
from rigid.naturalness.side_by_side import SideBySide
from rigid.policies.gaussian import GaussianParameters, with_memory
from rigid.policies.networks import MLP
from rigid.tasks.protocol import Task, World

MINIBATCHES = 4
"""Of one iteration's steps, so that a family of few slots takes as many gradient steps. Ours."""


class Family(NamedTuple):
    """Adversaries of one network in training; a pytree, so that it can be saved."""

    learner: Learner
    measures: Any
    """States of the slots' search measures, stacked."""
    penalty_std: Float[Array, " S"]
    """σ_P of each slot, frozen."""
    average: MLP
    """Moving average of the policy's network over iterations: what its adversaries are."""
    iteration: Int[Array, ""]


def start_family(
    opponent: Opponent, settings: AdversarySettings, range_: Range, key: PRNGKeyArray
) -> Family:
    """A family before any step, with room for codes that nothing heeds yet."""
    policy_key, critic_key, measure_key = jax.random.split(key, 3)
    policy, critic = first_networks(
        opponent, settings, (policy_key, critic_key), natural=range_.natural
    )
    policy, measures = told(policy), range_.measures(settings)
    canonical = canonical_motion(opponent)
    states = measures.start(measure_key, canonical, _at_home(opponent, settings))
    return Family(
        start_learner(settings.ppo, policy, _told_critic(critic), policy.normaliser),
        states,
        measures.unit(states, canonical),
        policy.network,
        jnp.asarray(0, jnp.int32),
    )


def _told_critic(critic: MLP) -> MLP:
    """Room for a code between the observation and the time left, which comes last."""
    first, *others = critic
    weights = first["w"]
    blind = jnp.zeros((CODE_SIZE, weights.shape[1]))
    return [{**first, "w": jnp.concatenate([weights[:-1], blind, weights[-1:]])}, *others]


def family_iteration(
    task: Task,
    world: World,
    families: Sequence[Family],
    ranges: Sequence[Range],
    opponent: Opponent,
    settings: AdversarySettings,
    seed: int,
) -> tuple[list[Family], dict[float, Metrics]]:
    """One iteration of every family: play, one policy update, one update of its measures.

    All randomness comes from (`seed`, iteration), as in `train_iteration`.

    Returns:
        The families after it, and what the slot of each λ saw.
    """
    iteration = int(families[0].iteration)
    rng = phase_rng(seed, "train", iteration)
    drawn = [draw(each, rng) for each in ranges]
    louder = [_louder(each, settings, iteration) for each in ranges]
    exploring = [
        _sampling(family.learner, opponent.human.log_std + np.log(factor, dtype=np.float32))
        for family, factor in zip(families, louder, strict=True)
    ]
    policies = [
        at_code(learner.policy, code)
        for learner, given in zip(exploring, drawn, strict=True)
        for code in given.codes
    ]
    played = play_group(task, world, policies, opponent, settings.episodes, settings.memory, rng)
    canonical = canonical_motion(opponent)
    key = jax.random.fold_in(jax.random.key(seed), iteration)
    after: list[Family] = []
    seen: dict[float, Metrics] = {}
    first = 0
    for index, (family, range_) in enumerate(zip(families, ranges, strict=True)):
        own = slice(first * settings.episodes, (first + range_.slots) * settings.episodes)
        updated, metrics = _update(
            family._replace(learner=exploring[index]),
            Experience(*(rows[:, own] for rows in played.experience)),
            drawn[index],
            canonical,
            jax.random.fold_in(key, index),
            settings=settings,
            remembered=range_.remembered(settings),
        )
        after.append(updated._replace(learner=_sampling(updated.learner, opponent.human.log_std)))
        metrics = jax.device_get(metrics)  # In JAX each slice would be a program.
        for lambda_ in range_.asked:
            slot = range_.slot(lambda_)
            mine = slice((first + slot) * settings.episodes, (first + slot + 1) * settings.episodes)
            seen[lambda_] = seen_by_task(_of_slot(metrics, slot), played, mine)
        first += range_.slots
    return after, seen


def _sampling(learner: Learner, log_std: Float[Array, " a"]) -> Learner:
    return learner._replace(policy=learner.policy._replace(log_std=log_std))


def _louder(range_: Range, settings: AdversarySettings, iteration: int) -> float:
    """Factor on the human's action noise in one iteration."""
    sharing = settings.sharing
    if sharing is None or range_.natural:
        return 1.0
    left = 1 - iteration / (sharing.wild_quiet_from * settings.iterations)
    return float(sharing.wild_noise ** max(left, 0.0))


def _of_slot(metrics: Metrics, slot: int) -> Metrics:
    """Only the entropy is of all slots."""
    own: Metrics = jax.tree.map(lambda each: each[slot] if each.ndim else each, metrics)
    return own


@partial(jax.jit, static_argnames=("settings", "remembered"))
def _update(
    family: Family,
    experience: Experience,
    drawn: Drawn,
    canonical: Float[Array, "E T f"],
    key: PRNGKeyArray,
    *,
    settings: AdversarySettings,
    remembered: float,
) -> tuple[Family, Metrics]:
    observation, action, reward, weight, features = experience
    slots, policy = len(drawn.lambdas), family.learner.policy
    measures = SideBySide(settings.search_measure, slots)
    codes = jnp.repeat(drawn.codes, settings.episodes, axis=0)
    lambdas = jnp.broadcast_to(jnp.repeat(drawn.lambdas, settings.episodes), weight.shape)
    shown = jnp.broadcast_to(codes, (*weight.shape, codes.shape[-1]))
    observation = jnp.concatenate([observation, shown], axis=-1)
    motions = Motion(*(_apart(x, slots) for x in (features, weight, observation, action)))
    penalty = measures.penalty(family.measures, canonical, motions, policy)
    scores = measures.score(family.measures, motions.features)
    keys = jax.random.split(key, 3)
    paid = _together(penalty / family.penalty_std[:, None, None])
    learner, losses = ppo_update(
        family.learner,
        rollout_of(observation, action, shaped_reward(lambdas, reward, paid), weight),
        keys[0],
        replace(settings.ppo, minibatch=weight.size // MINIBATCHES),
        pace_at(family.iteration, settings.iterations),
        blocks=slots,
    )
    states, health = measures.update(
        family.measures, canonical, motions, policy, family.iteration, keys[1:]
    )
    mean = jax.vmap(mean_of_sound)
    metrics = Metrics(
        mean_return=jnp.zeros(()),
        success=jnp.zeros(()),
        penalty=mean(penalty, motions.weight),
        naturalness_own=unknown() if scores is None else mean(scores < 0, motions.weight),
        entropy=losses.entropy,
        health=health,
    )
    average = jax.tree.map(
        lambda old, new: remembered * old + (1 - remembered) * new,
        family.average, learner.policy.network,
    )  # fmt: skip
    return Family(learner, states, family.penalty_std, average, family.iteration + 1), metrics


def _apart(x: Shaped[Array, "T N *k"], slots: int) -> Shaped[Array, "S T n *k"]:
    """The episodes of each slot."""
    return jnp.moveaxis(x.reshape(len(x), slots, -1, *x.shape[2:]), 1, 0)


def _together(x: Float[Array, "S T n"]) -> Float[Array, "T N"]:
    """The episodes of all slots, one slot after the other."""
    return jnp.moveaxis(x, 0, 1).reshape(x.shape[1], -1)


def members(
    families: Sequence[Family],
    ranges: Sequence[Range],
    opponent: Opponent,
    settings: AdversarySettings,
) -> Mapping[float, Adversary]:
    """What the families are at each λ that was asked for: their policies are ordinary networks."""
    home = _at_home(opponent, settings).network
    return {
        lambda_: Adversary(
            family.learner._replace(
                policy=at_code(_resting(family, home, range_.kept(lambda_, settings)), code)
            ),
            jax.tree.map(itemgetter(range_.slot(lambda_)), family.measures),
            family.penalty_std[range_.slot(lambda_)],
            jnp.asarray(lambda_, jnp.float32),
            family.iteration,
        )
        for family, range_ in zip(families, ranges, strict=True)
        for lambda_, code in zip(range_.lambdas, jnp.asarray(range_.codes()), strict=True)
        if lambda_ in range_.asked
    }


def _at_home(opponent: Opponent, settings: AdversarySettings) -> GaussianParameters:
    """The synthetic human, with room for what adversaries see and it does not heed."""
    return told(with_memory(opponent.human, settings.memory))


def _resting(family: Family, home: MLP, kept: float) -> GaussianParameters:
    """The policy that was learned, `kept` of the way from `home`."""
    away = family.average
    if kept < 1:
        away = jax.tree.map(lambda near, far: near + kept * (far - near), home, away)
    return family.learner.policy._replace(network=away)
