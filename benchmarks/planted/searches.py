"""The searches, each with the same environment steps: ours, and its rivals.

All end in the same number of humans, which one judge scores on fresh episodes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.planted.arena import Arena, play_with
from benchmarks.planted.diversity import diversity
from benchmarks.planted.people import fit_policy
from benchmarks.planted.plan import Plan
from rigid.frontier.largest_jump import first_lambdas
from rigid.learning.adversary_settings import SHARED, AdversarySettings
from rigid.learning.group_play import Opponent
from rigid.learning.searching import search_for
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.protocol import Policy

NOISES = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
"""Action noise of the Gaussian rival, in multiples of the canonical one. Ours."""
SABOTAGE = 0.0
"""λ of an adversary that nothing holds close."""


def search(method: str, arena: Arena, plan: Plan, seed: int) -> list[Policy]:
    """The humans that a method ends with.

    Args:
        method: One of `plan.METHODS`.
        arena: Robot, canonical data and human.
        plan: Budget.
        seed: Everything random comes from it.
    """
    searches: dict[str, Callable[[Arena, Plan, int], list[Policy]]] = {
        "rigid": _rigid,
        "clone": _clone,
        "diversity": _diversity,
        "sabotage": _sabotage,
        "noise": _noise,
    }
    return searches[method](arena, plan, seed)


def _rigid(arena: Arena, plan: Plan, seed: int) -> list[Policy]:
    """A discriminator holds adversaries close; all λ share a network, as in preset `standard`."""
    return _searched(arena, arena.opponent, _settings(plan, "lsgan"), plan, seed)


def _sabotage(arena: Arena, plan: Plan, seed: int) -> list[Policy]:
    """λ = 0, again and again, each time with a network of its own."""
    lambdas = [SABOTAGE] * plan.humans
    settings = AdversarySettings(iterations=plan.iterations, episodes=plan.episodes)
    return _trained(arena, arena.opponent, settings, lambdas, seed)


def _clone(arena: Arena, plan: Plan, seed: int) -> list[Policy]:
    """The penalty is the divergence from a clone of canonical episodes; all else is as in ours."""
    human = arena.opponent.human
    episodes = play_with(
        arena.task, arena.robot, GaussianPolicy(human), len(arena.opponent.canonical),
        np.random.default_rng([5, seed]),
    )  # fmt: skip
    seen, done = (
        rows.reshape(-1, rows.shape[-1])
        for rows in (episodes.human_observation, episodes.human_action)
    )
    std = float(np.exp(np.asarray(human.log_std)).mean())
    copied = fit_policy(seen, done, std=std, seed=seed).parameters
    opponent = arena.opponent._replace(human=copied)
    return _searched(arena, opponent, _settings(plan, "kl"), plan, seed)


def _diversity(arena: Arena, plan: Plan, seed: int) -> list[Policy]:
    """Evolution of the last layer, with an archive."""
    return diversity(arena, seed, steps=plan.steps, humans=plan.humans)


def _noise(arena: Arena, plan: Plan, seed: int) -> list[Policy]:
    """The canonical human with less and with more action noise; nothing is learned."""
    del plan, seed
    human = arena.opponent.human
    return [
        GaussianPolicy(human._replace(log_std=human.log_std + np.float32(np.log(level))))
        for level in NOISES
    ]


def _settings(plan: Plan, measure: str) -> AdversarySettings:
    """Those of preset `standard` at this study's budget."""
    return AdversarySettings(
        iterations=plan.iterations, episodes=plan.episodes, measure=measure,
        sharing=plan.sharing, ppo=SHARED,
    )  # fmt: skip


def _searched(
    arena: Arena, opponent: Opponent, settings: AdversarySettings, plan: Plan, seed: int
) -> list[Policy]:
    lambdas = first_lambdas(plan.lambda_min, plan.lambda_max, plan.humans)
    return _trained(arena, opponent, settings, lambdas, seed)


def _trained(
    arena: Arena,
    opponent: Opponent,
    settings: AdversarySettings,
    lambdas: Sequence[float],
    seed: int,
) -> list[Policy]:
    """One adversary for each λ, with the product's own training."""
    training = search_for(arena.task, opponent, settings, lambdas, seed)
    world, state = arena.task.make_world(training.blocks * settings.episodes), training.start()
    for _ in range(settings.iterations):
        state, _ = training.iterate(world, state)
    return [GaussianPolicy(adversary.learner.policy) for adversary in training.adversaries(state)]
