"""`rigid calibrate`: the range of adversarialness of a task, measured and frozen in a file.

0 and 1 of adversarialness stand at the rounded mean returns of canonical play and of λ = 0, the
adversary that nothing holds close (ours; the paper gives no range). Frozen, since robots are only
comparable on the same range.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.compute.executors.executor import Executor
from rigid.compute.listening import Listener
from rigid.compute.measurement import measure_robot
from rigid.compute.return_range import FORMAT, ReturnRange
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.compute.run.provenance import command_line, provenance
from rigid.compute.subject import Subject, canonical_path, load_players
from rigid.data.episodes import load_episodes
from rigid.data.recording import record
from rigid.doctor.noise import DEVIATIONS, deviations_below, mean_and_error
from rigid.errors import UserError
from rigid.files import json_text, write_atomically
from rigid.frontier.result import Frontier
from rigid.policies.passive import PassivePolicy
from rigid.presets import Preset

SABOTAGE = 0.0
"""λ of an adversary that nothing holds close."""
ROUNDING = "to the nearest multiple of the power of ten at which best - worst has two digits"
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
FAR = 10.0
"""Sabotage that lies so many times further below canonical play than that itself reaches is no
measure of natural failures. Ours: canonical play that goes twice as badly as usual then moves
adversarialness by a tenth at most, and whatever natural humans do lies in the axis's first few."""
EPISODES = 200
"""Of canonical play; as many as preset `paper` scores an adversary on."""
_SEED = 3  # Of recordings: neither the search's, nor the ruler's, nor those of the referee's gates.
_BLOCK = 100  # Episodes played side by side, as in every recording.


def calibrate(
    subject: Subject,
    preset: Preset,
    *,
    out: Path,
    run: Path,
    executor: Executor | None = None,
    listener: Listener,
) -> dict[str, Any]:
    """Measures the range and writes it to `out`.

    Args:
        subject: Task, robot and human; recorded canonical episodes where there are any.
        preset: How long the sabotage is trained, with which seeds, and on how many episodes scored.
        out: The file (.json).
        run: Run directory of the sabotage; an interrupted calibration in it goes on.
        executor: Where it is trained; by default on this machine.
        listener: Told of progress.

    Returns:
        What the file holds.

    Raises:
        UserError: Bad input, or sabotage that does not lower the return beyond noise.
    """
    subject = replace(subject, return_range=provisional_range(subject))
    recorded = _recorded_returns(subject)  # Damaged files are told before the training.
    frontier = measure_robot(
        subject, preset, out=run, lambdas=(SABOTAGE,), executor=executor, listener=listener
    )
    listener.say(f"playing {EPISODES} canonical episodes")
    returns = {"canonical": [canonical_returns(subject, EPISODES, _SEED)]}
    if recorded is not None:
        returns["recorded"] = [recorded]
    returns["sabotage"] = returns_at(frontier, SABOTAGE)
    found = _range_file(subject, preset, frontier, run, returns)
    write_atomically(out, json_text(found, indent=1).encode())
    return found


def _range_file(
    subject: Subject,
    preset: Preset,
    frontier: Frontier,
    run: Path,
    returns: Mapping[str, Sequence[Float[np.ndarray, " _n"]]],
) -> dict[str, Any]:
    """What the file holds, given the returns of each kind of play."""
    natural = returns.get("recorded", returns["canonical"])[0]
    worst, best = range_of_returns(returns["sabotage"], natural)
    identity = read_settings(RunDirectory(run))["identity"]
    return {
        "format": FORMAT,
        "kind": "return-range",
        "task": dict(subject.task.describe()),
        "worst": worst,
        "best": best,
        "rounding": ROUNDING,
        "robot": {"name": subject.robot, "sha256": identity["robot"]},
        "human": {"name": subject.human, "sha256": identity["human"]},
        "canonical": {"name": subject.canonical, "sha256": identity["canonical"]},
        "returns": {kind: spread_of(groups) for kind, groups in returns.items()},
        "sabotage_by_seed": {
            str(point["seed"]): point["return"] for point in _at(frontier, SABOTAGE)
        },
        "budget": preset.describe(),
        "env_steps": frontier.data["env_steps"],
        "date": datetime.now(UTC).date().isoformat(),
        "provenance": provenance(command_line()),
    }


def provisional_range(subject: Subject) -> ReturnRange:
    """A range for a search that looks at returns alone: the user's, the task's, else a guess.

    Raises:
        UserError: The players are not what they have to be.
    """
    if subject.return_range is not None:
        return subject.return_range
    if subject.task.return_range is not None:
        return ReturnRange(*subject.task.return_range, "task")
    robot, human = load_players(subject)
    passive = PassivePolicy(human.observation_size, human.action_size)
    natural, other = (
        record(
            subject.task, robot, player, episodes=_BLOCK, seed=_SEED, batch=_BLOCK, provenance={}
        ).returns
        for player in (human, passive)
    )
    best = float(natural.mean())
    reach = max(abs(best - float(other.mean())), 3 * float(natural.std()), 1e-6 * abs(best))
    return ReturnRange(best - (reach or 1.0), best, "provisional")


def canonical_returns(subject: Subject, episodes: int, seed: int) -> Float[np.ndarray, " _n"]:
    """Returns of fresh episodes of the robot with its own human.

    Raises:
        UserError: The players are not what they have to be.
    """
    robot, human = load_players(subject)
    found = record(
        subject.task, robot, human, episodes=episodes, seed=seed, batch=_BLOCK, provenance={}
    )
    return np.asarray(found.returns)


def returns_at(frontier: Frontier, lambda_: float | str) -> list[Float[np.ndarray, " _n"]]:
    """Returns of the scored episodes of each seed's adversary of one λ; those that ran away aside.

    Raises:
        UserError: Every episode of a seed ran away.
    """
    found = []
    for point in _at(frontier, lambda_):
        place = RunDirectory(frontier.directory).adversary(point["id"])
        with np.load(place / "episodes.npz", allow_pickle=False) as file:
            returns, faulted = file["returns"], file["faulted"]
        sound = returns[faulted == 0]
        if not len(sound):
            raise UserError(
                f"in every episode of adversary {point['id']} the physics of task "
                f"{frontier.data['task']!r} ran away: use a smaller physics step"
            )
        found.append(np.asarray(sound, dtype=np.float64))
    return found


def range_of_returns(
    sabotage: Sequence[Float[np.ndarray, " _n"]], natural: Float[np.ndarray, " _n"]
) -> tuple[float, float]:
    """(worst, best) from the returns of λ = 0 of each seed and of canonical behaviour.

    Raises:
        UserError: Sabotage does not lower the return beyond noise.
    """
    worst, error = mean_and_error(sabotage)
    best, natural_error = mean_and_error([natural])
    if not deviations_below(sabotage, natural) >= DEVIATIONS:  # NaN is not.
        raise UserError(
            f"λ = 0 earns {worst:.4g} ± {error:.2g} and canonical play {best:.4g} ± "
            f"{natural_error:.2g} (mean return and its standard error), so sabotage does not lower "
            "the return beyond noise: either the human cannot influence the reward, or the "
            "adversary needs more --iterations; `rigid doctor` tells which"
        )
    return rounded_range(worst, best)


def rounded_range(worst: float, best: float) -> tuple[float, float]:
    """Both ends to the nearest multiple of the power of ten at which their distance has two digits.

    Neither where returns begin nor in which unit they are counted moves what is rounded away: at
    most 5 % of the range at either end.

    Example:
        >>> rounded_range(-271.7, 453.9)
        (-270.0, 450.0)
        >>> rounded_range(1000.123, 1002.6)
        (1000.1, 1002.6)
    """
    digit = math.floor(math.log10(best - worst)) - 1
    return round(worst, -digit) + 0.0, round(best, -digit) + 0.0  # No minus zero.


def natural_reach(returns: Mapping[str, Mapping[str, Any]]) -> tuple[float, float]:
    """How far canonical returns themselves reach, and how many times further sabotage lies below.

    The reach is the mean return's size or the width of the middle 90 %, whichever is more: the
    size, since rewards whose canonical returns are all alike still tell success from none; the
    width, since returns around 0 have no size.

    Args:
        returns: `spread_of` each kind of play, as the file has it.

    Returns:
        The reach, and the distance to sabotage in units of it; 0 where there is no reach.

    Example:
        >>> play = {"mean": -3.0, "quantiles": {"0.05": -5.0, "0.95": -1.0}}
        >>> natural_reach({"canonical": play, "sabotage": {"mean": -83.0}})
        (4.0, 20.0)
    """
    natural = returns.get("recorded", returns["canonical"])
    mean, ends = natural["mean"], natural["quantiles"]
    reach = max(abs(mean), ends["0.95"] - ends["0.05"])
    return reach, (mean - returns["sabotage"]["mean"]) / reach if reach else 0.0


def spread_of(groups: Sequence[Float[np.ndarray, " _n"]]) -> dict[str, Any]:
    """How returns of one kind of play are spread, as the file has it."""
    everything = np.concatenate(groups)
    mean, error = mean_and_error(groups)
    return {
        "episodes": len(everything),
        "mean": mean,
        "se": error if len(everything) > 1 else None,
        "quantiles": {
            str(share): float(value)
            for share, value in zip(QUANTILES, np.quantile(everything, QUANTILES), strict=True)
        },
    }


def _at(frontier: Frontier, lambda_: float | str) -> list[Mapping[str, Any]]:
    return [point for point in frontier.points if point["lambda"] == lambda_]


def _recorded_returns(subject: Subject) -> Float[np.ndarray, " _n"] | None:
    """Known returns of people; None where fewer than two are, or the data are not of people."""
    path = canonical_path(subject)
    if path is None:
        return None
    episodes = load_episodes(path, task=subject.task)
    known = episodes.returns[np.isfinite(episodes.returns)]
    return np.asarray(known) if episodes.source == "recorded" and len(known) > 1 else None
