"""`rigid referee --check`: whether the referee may be believed on one task, with one robot.

Trains adversaries at the ends of the search, as a measurement does, and judges canonical data,
shuffles, planted shifts and these adversaries. A level whose gates fail may not be the x axis.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.listening import Listener
from rigid.compute.measurement import measure_robot
from rigid.compute.playing import play_with
from rigid.compute.referee.verdict import Gate, Verdict, at_least, ends_gates, planted_gates
from rigid.compute.search.scoring import seen_by_referee
from rigid.compute.subject import Subject, load_players
from rigid.data.recording import record
from rigid.files import json_text, write_atomically
from rigid.learning.rollout import policy_actor
from rigid.naturalness.gates import (
    COMPANY,
    SHUFFLES,
    SPLITS,
    Bench,
    Sizes,
    canonical_splits,
    label_shuffles,
    moved_by_company,
    planted_shifts,
)
from rigid.naturalness.panel import LEVEL_NAMES, Fold
from rigid.naturalness.referee import RefereeSettings
from rigid.naturalness.views import Episodes
from rigid.policies.loading import load_policy
from rigid.policies.protocol import Policy
from rigid.presets import Preset

VERDICT_FILE = "referee-check.json"
SABOTAGE = 0.0
"""λ of an adversary that nothing holds close."""
_SEED = 2  # Of recordings: neither the search's nor the ruler's.
_BLOCK = 100  # Episodes played side by side, as in every recording.


def check_referee(subject: Subject, preset: Preset, *, out: Path, listener: Listener) -> Verdict:
    """Runs every gate; writes `referee-check.json` into `out`, beside the adversaries it trained.

    Args:
        subject: Task, robot, human.
        preset: How long adversaries are trained, and on how many episodes all are judged.
        out: Run directory of the adversaries; an interrupted check goes on in it.
        listener: Told of progress.

    Raises:
        UserError: Bad input; nothing was overwritten.
    """
    lambdas = (SABOTAGE, preset.lambda_max)
    run = measure_robot(subject, preset, out=out, lambdas=lambdas, listener=listener)
    sizes = Sizes(
        preset.referee_canonical, preset.referee_episodes, preset.validation_episodes,
        preset.scoring_episodes,
    )  # fmt: skip
    ends = {end: [point for point in run.points if point["lambda"] == end] for end in lambdas}
    gates = [
        *ends_gates(ends[SABOTAGE], ends[preset.lambda_max]),
        *_recipe_gates(subject, out, sizes, ends, listener),
    ]
    gates.sort(key=lambda gate: LEVEL_NAMES.index(gate.level))
    verdict = Verdict(
        tuple(gates),
        {
            "task": subject.task.name,
            "robot": subject.robot,
            "human": subject.human,
            "preset": preset.name,
            "episodes": sizes._asdict(),
            "iterations": preset.iterations,
            "seeds": list(preset.seeds),
            "referee": asdict(RefereeSettings()),
        },
    )
    write_atomically(out / VERDICT_FILE, json_text(verdict.describe(), indent=1).encode())
    return verdict


def _recipe_gates(
    subject: Subject,
    out: Path,
    sizes: Sizes,
    ends: Mapping[float, Sequence[Mapping[str, Any]]],
    listener: Listener,
) -> list[Gate]:
    task = subject.task
    robot, human = load_players(subject)
    listener.say("playing episodes for the gates")
    pool = record(
        task, robot, human, episodes=sizes.pool, seed=_SEED, batch=_BLOCK, provenance={}
    ).features
    sabotage, natural = (
        _play_all(subject, robot, out, [point["id"] for point in points], count)
        for points, count in (
            (ends[SABOTAGE], COMPANY * (sizes.train + sizes.validation)),
            (list(ends.values())[1][:1], sizes.adversary),
        )
    )
    bench = Bench(sizes, RefereeSettings(), _counted(listener))
    sound = sabotage.features[sabotage.sound.all(axis=1)]
    half = -(-sizes.pool // 2)
    gates = at_least("canonical against itself", canonical_splits(pool, bench), 0.97)
    listener.say(f"{SPLITS} splits of canonical episodes are judged")
    gates += at_least("shuffled labels", label_shuffles(pool[:half], sound[:half], bench), 0.97)
    listener.say(f"{SHUFFLES} shuffles of labels are judged")
    gates += planted_gates([found for part in planted_shifts(pool, bench) for found in part])
    fold = Fold(*np.split(pool[: 3 * sizes.canonical], 3))
    moves = moved_by_company(fold, natural, sabotage, bench)
    gates += [
        Gate(f"moved by {COMPANY} sabotage adversaries", level, move, 0.02, at_least=False)
        for level, move in moves.items()
    ]
    return gates


def _play_all(
    subject: Subject, robot: Policy, out: Path, names: Sequence[str], count: int
) -> Episodes:
    """At least `count` episodes of some adversaries, in equal parts, from starts of their own."""
    each = -(-count // len(names))
    parts = []
    for number, name in enumerate(names):
        human = load_policy(str(out / "adversaries" / name), task=subject.task, agent="human")
        rng = np.random.default_rng([_SEED, number])
        starts = rng.integers(2**31, size=each)
        actor = policy_actor(human, each, rng)
        parts.append(seen_by_referee(play_with(subject.task, robot, actor, starts)))
    return Episodes(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _counted(listener: Listener) -> Callable[[], None]:
    done = 0

    def advance() -> None:
        nonlocal done
        done += 1
        if done % 5 == 0:
            listener.say(f"gates: {done} panels of referees trained")

    return advance
