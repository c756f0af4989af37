"""Adversaries that share a network: one policy learns for many λ at a time.

What one λ learns of the robot's weak places serves its neighbours, so that a group of them costs no
more for being dense. A family is one network with one search measure; at each iteration it plays at
as many λ of its range as it has slots, and a code tells network and measure which is meant. There
are two families (`Sharing`): one starts from random weights, one at the synthetic human. Ours.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, PRNGKeyArray

from rigid.learning.adversary import (
    Adversary,
    AdversarySettings,
    Metrics,
    first_networks,
    mean_of_sound,
    pace_at,
    rollout_of,
    seen_by_task,
    shaped_reward,
)
from rigid.learning.conditioned import (
    CODE_SIZE,
    Sharing,
    at_code,
    codes_at,
    draw_places,
    lambda_at,
    slot_of,
    told,
)
from rigid.learning.group_play import (
    Experience,
    Opponent,
    canonical_motion,
    phase_rng,
    play_group,
)
from rigid.learning.ppo import Learner, ppo_update, start_learner
from rigid.naturalness.measure import Motion, unknown
from rigid.naturalness.told import ToldState, with_code
from rigid.policies.gaussian import with_memory
from rigid.policies.networks import MLP
from rigid.tasks.protocol import Task, World

MINIBATCHES = 4
"""Of one iteration's steps, so that a family of few slots takes as many gradient steps. Ours."""


class Family(NamedTuple):
    """Adversaries of one network in training; a pytree, so that it can be saved."""

    learner: Learner
    measure: Any
    """State of the search measure that all of them share."""
    penalty_std: Float[Array, ""]
    """σ_P, frozen."""
    iteration: Int[Array, ""]


class Range(NamedTuple):
    """The ascending λ between which one family trains, and how many of them it plays at a time."""

    lambdas: tuple[float, ...]
    """Those that were asked for, and the one that it trains at for their sake."""
    asked: tuple[float, ...]
    slots: int
    natural: bool
    """Whether it starts at the synthetic human."""

    def codes(self) -> Float[np.ndarray, "L c"]:
        """The code of each λ."""
        return codes_at(np.arange(len(self.lambdas), dtype=float), len(self.lambdas))


class Drawn(NamedTuple):
    """What the slots of one family play in one iteration."""

    lambdas: Float[Array, " S"]
    codes: Float[Array, "S c"]


def ranges_of(lambdas: Sequence[float], sharing: Sharing) -> list[Range]:
    """The λ of each family that was asked for any; the wild one comes first.

    Example:
        >>> for each in ranges_of([3.0, 0.0], Sharing(wild_slots=2, natural_slots=3)):
        ...     print(each)
        Range(lambdas=(0.0, 0.4), asked=(0.0,), slots=2, natural=False)
        Range(lambdas=(0.1, 3.0), asked=(3.0,), slots=3, natural=True)
    """
    wild = {value for value in lambdas if value < sharing.natural_start}
    natural = set(lambdas) - wild
    families = (
        (wild, sharing.wild_to, sharing.wild_slots, False),
        (natural, sharing.natural_from, sharing.natural_slots, True),
    )
    return [
        Range(tuple(sorted(asked | {beyond})), tuple(sorted(asked)), slots, from_human)
        for asked, beyond, slots, from_human in families
        if asked
    ]


def start_family(
    opponent: Opponent, settings: AdversarySettings, range_: Range, key: PRNGKeyArray
) -> Family:
    """A family before any step, with room for codes that nothing heeds yet."""
    policy_key, critic_key, measure_key = jax.random.split(key, 3)
    policy, critic = first_networks(
        opponent, settings, (policy_key, critic_key), natural=range_.natural
    )
    policy, measure = told(policy), settings.shared_measure
    # Under one code: before training scores differ between codes by chance, which is no unit.
    code = jnp.asarray(range_.codes()[len(range_.lambdas) // 2])
    canonical = with_code(canonical_motion(opponent), code)
    state = measure.start(
        measure_key, canonical, told(with_memory(opponent.human, settings.memory))
    )
    return Family(
        start_learner(settings.ppo, policy, _told_critic(critic), policy.normaliser),
        state,
        measure.unit(state, canonical),
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
    """One iteration of every family: play, one policy update, one update of its measure.

    All randomness comes from (`seed`, iteration), as in `train_iteration`.

    Returns:
        The families after it, and what the slot of each λ saw.
    """
    iteration = int(families[0].iteration)
    rng = phase_rng(seed, "train", iteration)
    drawn = [_draw(each, rng) for each in ranges]
    policies = [
        at_code(family.learner.policy, code)
        for family, given in zip(families, drawn, strict=True)
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
            family,
            Experience(*(rows[:, own] for rows in played.experience)),
            drawn[index],
            canonical,
            jax.random.fold_in(key, index),
            settings=settings,
        )
        after.append(updated)
        for lambda_ in range_.asked:
            number = range_.lambdas.index(lambda_)
            slot = slot_of(number, len(range_.lambdas), range_.slots)
            mine = slice((first + slot) * settings.episodes, (first + slot + 1) * settings.episodes)
            seen[lambda_] = seen_by_task(_of_slot(metrics, slot), played, mine)
        first += range_.slots
    return after, seen


def _draw(range_: Range, rng: np.random.Generator) -> Drawn:
    count = len(range_.lambdas)
    places = draw_places(count, range_.slots, rng)
    lambdas = jnp.array([lambda_at(range_.lambdas, place) for place in places])
    return Drawn(lambdas, jnp.asarray(codes_at(places, count)))


def _beside(
    canonical: Float[Array, "E T f"], codes: Float[Array, "S c"]
) -> Float[Array, "ES T fc"]:
    """Every canonical episode beside every code, so that a code alone tells nothing.

    Neighbours have different codes: canonical rows that stand in for those after a fault are the
    first ones, and must not all be of one λ.
    """
    again = jnp.repeat(canonical, len(codes), axis=0)
    return with_code(again, jnp.tile(codes, (len(canonical), 1))[:, None])


def _of_slot(metrics: Metrics, slot: int) -> Metrics:
    penalty, own = metrics.penalty[slot], metrics.naturalness_own[slot]
    return metrics._replace(penalty=penalty, naturalness_own=own)


@partial(jax.jit, static_argnames="settings")
def _update(
    family: Family,
    experience: Experience,
    drawn: Drawn,
    canonical: Float[Array, "E T f"],
    key: PRNGKeyArray,
    *,
    settings: AdversarySettings,
) -> tuple[Family, Metrics]:
    observation, action, reward, weight, features = experience
    slots, measure, policy = len(drawn.lambdas), settings.shared_measure, family.learner.policy
    codes = jnp.repeat(drawn.codes, settings.episodes, axis=0)
    lambdas = jnp.broadcast_to(jnp.repeat(drawn.lambdas, settings.episodes), weight.shape)
    canonical = _beside(canonical, drawn.codes)
    shown = jnp.broadcast_to(codes, (*weight.shape, codes.shape[-1]))
    observation = jnp.concatenate([observation, shown], axis=-1)
    motion = Motion(with_code(features, codes), weight, observation, action)
    penalty = measure.penalty(family.measure, canonical, motion, policy)
    scores = measure.score(family.measure, motion.features)
    keys = jax.random.split(key, 3)
    learner, losses = ppo_update(
        family.learner,
        rollout_of(
            observation,
            action,
            shaped_reward(lambdas, reward, penalty / family.penalty_std),
            weight,
        ),
        keys[0],
        replace(settings.ppo, minibatch=weight.size // MINIBATCHES),
        pace_at(family.iteration, settings.iterations),
        blocks=slots,
    )
    state, health = measure.update(
        family.measure, canonical, motion, policy, family.iteration, keys[1:]
    )
    own = jnp.full(slots, unknown()) if scores is None else _by_slot(scores < 0, weight, slots)
    metrics = Metrics(
        mean_return=jnp.zeros(()),
        success=jnp.zeros(()),
        penalty=_by_slot(penalty, weight, slots),
        naturalness_own=own,
        entropy=losses.entropy,
        health=health,
    )
    return Family(learner, state, family.penalty_std, family.iteration + 1), metrics


def _by_slot(x: Array, weight: Float[Array, "T N"], slots: int) -> Float[Array, " S"]:
    """Mean over the sound steps of each slot's episodes."""
    apart = (jnp.moveaxis(rows.reshape(len(rows), slots, -1), 1, 0) for rows in (x, weight))
    means: Float[Array, " S"] = jax.vmap(mean_of_sound)(*apart)
    return means


def members(families: Sequence[Family], ranges: Sequence[Range]) -> Mapping[float, Adversary]:
    """What the families are at each λ that was asked for: their policies are ordinary networks."""
    return {
        lambda_: Adversary(
            family.learner._replace(policy=at_code(family.learner.policy, code)),
            ToldState(family.measure, code),
            family.penalty_std,
            jnp.asarray(lambda_, jnp.float32),
            family.iteration,
        )
        for family, range_ in zip(families, ranges, strict=True)
        for lambda_, code in zip(range_.lambdas, jnp.asarray(range_.codes()), strict=True)
        if lambda_ in range_.asked
    }
