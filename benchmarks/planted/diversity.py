"""The rival that the paper suggests: quality-diversity search, here CMA-MAE (Fontaine, 2023).

It perturbs the last layer of the canonical policy, keeps the most harmful humans in an archive over
how far they depart from it and where they lead, and never trains. How far a human departs is the
exact divergence of its actions: more than a search of real people could know.
"""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from benchmarks.planted.arena import Arena
from rigid.learning.group_play import group_actor, phase_rng
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.naturalness.kl import log_ratio
from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import adversarialness

EPISODES = 24
"""Of one candidate. Ours, like every number here."""
EMITTERS, BATCH = 4, 15
CELLS = (20, 10)
DEPARTURE = (-3.0, 1.0)
"""Range of the archive's first axis: log₁₀ of the divergence [nat per step]."""
ACROSS = (-0.5, 0.5)
"""Range of its second axis: where hands end on average, across [m]."""
SIGMA = 0.02
"""First step of the evolution strategies, in the last layer's own units."""
LEARNING_RATE = 0.1
"""Of the archive's thresholds: between CMA-ME (1) and plain optimisation (0)."""


def diversity(arena: Arena, seed: int, *, steps: int, humans: int) -> list[Policy]:
    """The most harmful human of each of `humans` ranges of departure from the canonical one.

    Args:
        arena: Robot and canonical human.
        seed: Everything random comes from it.
        steps: Environment steps to spend.
        humans: How many to return; fewer where the archive has none in a range.
    """
    scheduler, kept = _scheduler(arena.opponent.human, seed)
    canonical = arena.opponent.human
    for generation in range(steps // (EMITTERS * BATCH * EPISODES * arena.task.horizon)):
        solutions = scheduler.ask()
        scheduler.tell(*_tried(arena, [_perturbed(canonical, one) for one in solutions],
                               seed, generation))  # fmt: skip
    found = kept.data(("solution", "objective", "measures"))
    places = np.linspace(*DEPARTURE, humans + 1)[1:-1]
    ranges = np.digitize(found["measures"][:, 0], places)
    best = [
        max(np.flatnonzero(ranges == number), key=lambda cell: found["objective"][cell])
        for number in np.unique(ranges)
    ]
    return [GaussianPolicy(_perturbed(canonical, found["solution"][cell])) for cell in best]


def _scheduler(canonical: GaussianParameters, seed: int) -> tuple[Any, Any]:
    """Evolution strategies with their archive, and an archive of the best that was ever seen."""
    from ribs.archives import GridArchive  # An extra, so only where it is used.
    from ribs.emitters import EvolutionStrategyEmitter
    from ribs.schedulers import Scheduler

    size = canonical.network[-1]["w"].size + canonical.network[-1]["b"].size
    archive, kept = (
        GridArchive(
            solution_dim=size, dims=CELLS, ranges=(DEPARTURE, ACROSS), seed=seed,
            learning_rate=rate, threshold_min=floor,
        )
        for rate, floor in ((LEARNING_RATE, 0.0), (None, -np.inf))
    )  # fmt: skip
    emitters = [
        EvolutionStrategyEmitter(
            archive, x0=np.zeros(size), sigma0=SIGMA, ranker="imp", es="sep_cma_es",
            batch_size=BATCH, seed=seed + number,
        )
        for number in range(EMITTERS)
    ]  # fmt: skip
    return Scheduler(archive, emitters, result_archive=kept), kept


def _perturbed(policy: GaussianParameters, change: Float[np.ndarray, " d"]) -> GaussianParameters:
    """The policy with `change` added to its last layer, weights first."""
    *layers, last = policy.network
    count = last["w"].size
    changed = {
        "w": last["w"] + jnp.asarray(change[:count], jnp.float32).reshape(last["w"].shape),
        "b": last["b"] + jnp.asarray(change[count:], jnp.float32),
    }
    return policy._replace(network=[*layers, changed])


def _tried(
    arena: Arena, policies: list[GaussianParameters], seed: int, generation: int
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n 2"]]:
    """Adversarialness of each candidate, and its place in the archive."""
    rng = phase_rng(seed, "train", generation)
    starts = np.tile(rng.integers(2**31, size=EPISODES), len(policies))
    played = play(
        arena.task, arena.task.make_world(len(starts)), starts,
        policy_actor(arena.robot, len(starts), None), group_actor(policies, rng),
    )  # fmt: skip
    assert arena.task.return_range is not None
    harm = adversarialness(played.returns, arena.task.return_range).reshape(-1, EPISODES)
    return harm.mean(axis=1), np.stack([
        np.log10(np.maximum(_departures(arena, policies, played), 10.0 ** DEPARTURE[0])),
        played.features[-1, :, 0].reshape(-1, EPISODES).mean(axis=1),
    ], axis=1)  # fmt: skip


def _departures(
    arena: Arena, policies: list[GaussianParameters], played: Trajectories
) -> Float[np.ndarray, " n"]:
    """Mean log-ratio of each candidate's actions [nat per step]."""
    found = []
    for number, policy in enumerate(policies):
        mine = slice(number * EPISODES, (number + 1) * EPISODES)
        seen, done = (
            jnp.asarray(rows[:, mine]) for rows in (played.human_observation, played.human_action)
        )
        found.append(float(log_ratio(policy, arena.opponent.human, seen, done).mean()))
    return np.array(found)
