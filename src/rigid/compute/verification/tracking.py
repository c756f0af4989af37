"""Hand tracking under the exact KL penalty: many steps, a critic, and a known best response.

For each robot and λ the adversary must cost what the exact optimum costs, at its KL divergence. As
the search keeps the synthetic human's noise, and the human has no clock, the optimum is that of one
gain for all steps with this noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import jax.numpy as jnp
import numpy as np

from rigid.compute.verification.cases import Advance
from rigid.compute.verification.resting import (
    Effort,
    Rested,
    adversary_settings,
    come_to_rest,
    opponent_of,
    play_rested,
)
from rigid.learning.group_play import Opponent
from rigid.learning.ppo import PPOSettings
from rigid.learning.rollout import Trajectories
from rigid.naturalness.kl import log_ratio
from rigid.tasks.analytic.hand_tracking import HORIZON, NOISE, HandTracking
from rigid.tasks.analytic.linear_quadratic import breakdown_lambda, steady_optimum

GAINS = (0.5, 0.2)
MULTIPLES = (1.5, 2.0, 4.0)
"""λ in units of the one at which the optimum breaks down."""
STANDARD_ERRORS = 3.0
_PPO = PPOSettings(
    learning_rate=3e-4, gamma=1.0, gae_lambda=1.0, epochs=2, minibatch=2048, update_normaliser=False
)
"""No discount, as in the formulas, and returns instead of the critic's word, which is biased. Slow:
a step moves the gain by .006 at most, where the optimum is .05 to .2."""


def for_tracking(effort: Effort) -> Effort:
    """The effort of hand tracking: twenty steps in an episode, and no discriminator to follow."""
    return replace(effort, ppo=_PPO, episodes=effort.episodes // 2, canonical=200)


def env_steps(effort: Effort) -> int:
    """Training steps of both robots."""
    ours = for_tracking(effort)
    runs = len(GAINS) * len(MULTIPLES) * len(ours.seeds)
    return runs * ours.iterations * ours.episodes * HORIZON


def rows(effort: Effort, advance: Advance) -> list[dict[str, Any]]:
    """One row for each robot and λ: means over seeds, standard errors, exact values."""
    ours, found = for_tracking(effort), []
    for gain in GAINS:
        task = HandTracking(gain)
        lambdas = [m * breakdown_lambda(gain, NOISE**2, HORIZON) for m in MULTIPLES]
        by_seed = [_search(task, lambdas, ours, seed, advance) for seed in ours.seeds]
        for lambda_, pairs in zip(lambdas, np.stack(by_seed, axis=1), strict=True):
            found.append(_row(task, lambda_, pairs))
    return found


def _search(
    task: HandTracking, lambdas: Sequence[float], effort: Effort, seed: int, advance: Advance
) -> np.ndarray:
    """Cost and KL divergence of each adversary of one seed, [λ, 2]."""
    opponent = opponent_of(task, "builtin:tracker", effort, seed)
    settings = adversary_settings(effort, measure="kl")
    rested = come_to_rest(task, opponent, settings, lambdas, seed, advance)
    played = play_rested(task, opponent, rested, effort.scored, seed)
    return np.array([
        (-episodes.returns.mean(), _divergence(one, opponent, episodes))
        for one, episodes in zip(rested, played, strict=True)
    ])  # fmt: skip


def _divergence(rested: Rested, opponent: Opponent, episodes: Trajectories) -> float:
    """Mean over episodes of the summed log-ratio [nat]."""
    seen, done = jnp.asarray(episodes.human_observation), jnp.asarray(episodes.human_action)
    return float(log_ratio(rested.policy, opponent.human, seen, done).sum(axis=0).mean())


def _row(task: HandTracking, lambda_: float, pairs: np.ndarray) -> dict[str, Any]:
    exact = steady_optimum(lambda_, gain=task.gain, variance=NOISE**2, horizon=HORIZON)
    mean = pairs.mean(axis=0)
    error = pairs.std(axis=0, ddof=1) / np.sqrt(len(pairs))
    near = np.abs(mean - (exact.cost, exact.kl)) <= STANDARD_ERRORS * error
    return {
        "task": task.name, "gain": task.gain, "lambda": lambda_,
        "cost": float(mean[0]), "cost_exact": exact.cost, "cost_error": float(error[0]),
        "kl": float(mean[1]), "kl_exact": exact.kl, "kl_error": float(error[1]),
        "seeds": len(pairs), "ok": bool(near.all()),
    }  # fmt: skip
