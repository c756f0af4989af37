"""`rigid verify`: the search and its rulers against numbers that were computed without learning.

The task is offset catch, where the shift at which an adversary rests, its naturalness by its own
discriminator (N₄) and by the referee (x̄₄) have exact values; `docs/analytic.md` derives them. A row
is the mean over seeds at one λ, for one of three settings:

  * `amp`: the default penalty and a discriminator without stabilisers;
  * `amp, stabilised`: the default discriminator, against the optimum *with* its gradient penalty;
  * `paper_d2`: the penalty as printed, against the place to which it drives an adversary.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import jax
import numpy as np

from rigid.compute.verification.resting import (
    LIGHT,
    Effort,
    Rested,
    adversary_settings,
    come_to_rest,
    opponent_of,
    play_rested,
)
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.learning.group_play import Opponent
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.referee import (
    HEADLINE_KAPPA,
    RefereeSettings,
    Rows,
    log_ratio,
    overlap,
    train_referee,
)
from rigid.naturalness.standardise import canonical_scale
from rigid.policies.gaussian import GaussianPolicy
from rigid.tasks.analytic import mean_shift, regularised
from rigid.tasks.analytic.offset_catch import REACH, OffsetCatch
from rigid.tasks.protocol import Task

LAMBDAS = (4.0, 5.0, 6.0, 8.0, 10.0, 20.0)
"""From near the smallest λ that has an optimum (2.99) to an adversary at naturalness .99."""
PAPER_LAMBDAS = (20.0, 1000.0)
"""Of `paper_d2`: far above the default's, since its failure is what larger λ do not cure."""

SHIFT_TOLERANCE = 0.03
"""Canonical standard deviations. Ours: one seed spreads by about .01, and noise of the
discriminator's fit lets adversaries go .01 too far."""
NATURALNESS_TOLERANCE = 0.02
"""Of both naturalness columns: what a shift that is off by .03 makes of them at most. Ours."""

Advance = Callable[[int], None]


class Naturalness(NamedTuple):
    """What an adversary on offset catch was measured to be."""

    shift: float
    own: float
    """N₄."""
    referee: float
    """x̄₄."""
    cost: float
    """Mean cost of an episode."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One setting and its exact answers."""

    setting: str
    lambdas: tuple[float, ...]
    penalty: str
    discriminator: DiscriminatorSettings
    shift: Callable[[float], float]
    """Of λ."""
    naturalness: Callable[[float], float]
    """N₄ of a shift."""
    most_seeds: int = 1000
    """Of the effort's seeds only the first so many."""
    either_side: bool = False
    """Whether adversaries may go to the left as well: the distance is then what counts."""


def cases(lambdas: Sequence[float] = LAMBDAS) -> tuple[Case, ...]:
    """The three settings.

    Raises:
        UserError: A λ is too small to have an optimum.
    """
    least = mean_shift.smallest_lambda()
    for lambda_ in lambdas:
        if not least < lambda_ < np.inf:
            raise UserError(
                f"--lambdas {lambda_:g}: offset catch has an optimum for λ above {least:.3f} and "
                "below inf only; below it nothing holds the adversary"
            )
    default = DiscriminatorSettings()
    shape = regularised.Regularised(
        gradient_penalty=default.gradient_penalty, noise=default.noise_floor
    )
    own = mean_shift.naturalness
    return (
        Case(setting="amp", lambdas=tuple(lambdas), penalty="amp", discriminator=LIGHT,
             shift=mean_shift.optimal_shift, naturalness=own),
        Case(setting="amp, stabilised", lambdas=tuple(lambdas), penalty="amp",
             discriminator=default, most_seeds=2,
             shift=partial(regularised.optimal_shift, shape=shape),
             naturalness=partial(regularised.naturalness, shape=shape)),
        Case(setting="paper_d2", lambdas=PAPER_LAMBDAS, penalty="paper_d2", discriminator=LIGHT,
             shift=partial(mean_shift.optimal_shift, penalty="paper_d2"), naturalness=own,
             either_side=True),
    )  # fmt: skip


def env_steps(chosen: Sequence[Case], effort: Effort) -> int:
    """Training steps of these cases."""
    adversaries = sum(len(case.lambdas) * len(seeds_of(case, effort)) for case in chosen)
    return adversaries * effort.iterations * effort.episodes


def seeds_of(case: Case, effort: Effort) -> tuple[int, ...]:
    """Search seeds of a case."""
    return effort.seeds[: case.most_seeds]


def seconds_per_step(case: Case, effort: Effort) -> float:
    """Pace of training, from three iterations after those that compile."""
    task = OffsetCatch()
    opponent = opponent_of(task, "builtin:catcher", effort, 0)
    settings = adversary_settings(effort, case.discriminator, penalty=case.penalty)
    clock = []
    for _ in range(2):
        clock.append(time.perf_counter())
        come_to_rest(task, opponent, settings, case.lambdas[:1], 0, _ignored, iterations=3)
    return (time.perf_counter() - clock[1]) / (3 * effort.episodes)


def _ignored(_: int) -> None:
    """Probing is no progress."""


def rows_of(case: Case, effort: Effort, advance: Advance) -> list[dict[str, Any]]:
    """One row for each λ of a case: means over seeds beside the exact values."""
    task = OffsetCatch()
    by_seed = [
        search(task, case.lambdas, case, effort, seed, advance) for seed in seeds_of(case, effort)
    ]
    return [_row(case, lambda_, found) for lambda_, found in zip(
        case.lambdas, zip(*by_seed, strict=True), strict=True
    )]  # fmt: skip


def search(
    task: OffsetCatch,
    lambdas: Sequence[float],
    case: Case,
    effort: Effort,
    seed: int,
    advance: Advance,
) -> list[Naturalness]:
    """Adversaries of one seed, trained and measured."""
    opponent = opponent_of(task, "builtin:catcher", effort, seed)
    settings = adversary_settings(effort, case.discriminator, penalty=case.penalty)
    rested = come_to_rest(task, opponent, settings, lambdas, seed, advance)
    referees = referee_naturalness(task, opponent, rested, effort, seed)
    return [
        Naturalness(_shift(one), one.naturalness, natural, harm)
        for one, (natural, harm) in zip(rested, referees, strict=True)
    ]


def referee_naturalness(
    task: Task, opponent: Opponent, rested: Sequence[Rested], effort: Effort, seed: int
) -> list[tuple[float, float]]:
    """x̄₄ of each adversary by a referee of its own, and its mean cost, on fresh episodes."""
    human = GaussianPolicy(opponent.human)
    natural = record(  # None of these episodes is the search's: those have the seed itself.
        task, opponent.robot, human, episodes=3 * effort.scored, seed=10_000 + seed,
        batch=effort.scored, provenance={},
    ).features.reshape(3, effort.scored * task.horizon, -1)  # fmt: skip
    found = []
    for index, played in enumerate(play_rested(task, opponent, rested, 3 * effort.scored, seed)):
        rows = played.features.swapaxes(0, 1).reshape(natural.shape)
        referee = train_referee(
            Rows(natural[0], natural[1]), Rows(rows[0], rows[1]), canonical_scale(natural[0]),
            RefereeSettings(), jax.random.fold_in(jax.random.key(seed), index),
        )  # fmt: skip
        share = overlap(log_ratio(referee, rows[2]), log_ratio(referee, natural[2]), HEADLINE_KAPPA)
        found.append((share, float(-played.returns.mean())))
    return found


def _shift(rested: Rested) -> float:
    """Mean offset: the task shows the human nothing, so the mean action is one number."""
    action, _ = GaussianPolicy(rested.policy).act(np.zeros((1, 1), np.float32), (), None)
    return float(REACH * np.clip(action[0, 0], -1.0, 1.0))


def _row(case: Case, lambda_: float, found: Sequence[Naturalness]) -> dict[str, Any]:
    size = abs if case.either_side else float
    exact = case.shift(lambda_)
    row: dict[str, Any] = {
        "task": OffsetCatch.name,
        "setting": case.setting,
        "lambda": lambda_,
        "shift": float(np.mean([size(one.shift) for one in found])),
        "shift_exact": exact,
        "naturalness": float(np.mean([one.own for one in found])),
        "naturalness_exact": case.naturalness(exact),
        "overlap": float(np.mean([one.referee for one in found])),
        "overlap_exact": mean_shift.overlap(exact),
    }
    allowed = {
        "shift": SHIFT_TOLERANCE,
        "naturalness": NATURALNESS_TOLERANCE,
        "overlap": NATURALNESS_TOLERANCE,
    }
    near = (abs(row[name] - row[f"{name}_exact"]) <= limit for name, limit in allowed.items())
    return {**row, "seeds": len(found), "ok": all(near)}
