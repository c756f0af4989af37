"""`rigid referee --check`: whether the referee may be believed on one task, with one robot.

Trains adversaries at the ends of the search, as a measurement does, and judges canonical data,
shuffles, planted shifts and these adversaries. A level whose gates fail may not be the x axis.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.listening import Listener
from rigid.compute.measurement import measure_robot
from rigid.compute.preparation import Subject
from rigid.compute.provenance import provenance
from rigid.compute.scoring import play_with, seen_by_referee
from rigid.data.recording import record
from rigid.files import json_text, write_atomically
from rigid.learning.rollout import policy_actor
from rigid.naturalness.gates import (
    COMPANY,
    SHUFFLES,
    SPLITS,
    Bench,
    Planted,
    Sizes,
    Values,
    canonical_splits,
    label_shuffles,
    moved_by_company,
    planted_shifts,
)
from rigid.naturalness.panel import AXIS, LEVEL_NAMES, Fold
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


@dataclass(frozen=True)
class Gate:
    """One number and what it has to be."""

    name: str
    level: str
    """One of `LEVEL_NAMES`."""
    measured: float
    limit: float
    at_least: bool

    @property
    def passed(self) -> bool:
        """Whether the level may be believed as far as this gate sees."""
        if self.at_least:
            return self.measured >= self.limit
        return self.measured <= self.limit

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        return {**asdict(self), "passed": self.passed}


@dataclass(frozen=True)
class Verdict:
    """Every gate at every level."""

    gates: tuple[Gate, ...]
    about: Mapping[str, Any]
    """Task, robot, human, preset and what the adversaries were."""

    @property
    def failed(self) -> tuple[Gate, ...]:
        """Gates that the x axis does not pass."""
        return tuple(gate for gate in self.gates if gate.level == AXIS and not gate.passed)

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        sound = {
            level: all(gate.passed for gate in self.gates if gate.level == level)
            for level in dict.fromkeys(gate.level for gate in self.gates)
        }
        return {
            "schema": 1,
            **self.about,
            "axis": AXIS,
            "passed": not self.failed,
            "may_be_axis": sound,
            "gates": [gate.describe() for gate in self.gates],
            "provenance": provenance([]),
        }


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
        *_ends_gates(ends[SABOTAGE], ends[preset.lambda_max]),
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


def _ends_gates(
    sabotage: Sequence[Mapping[str, Any]], natural: Sequence[Mapping[str, Any]]
) -> list[Gate]:
    """What the ends of the search read: the worst sabotage, the mean of the largest λ."""
    gates = []
    for level in LEVEL_NAMES:
        low, high = (
            [p["naturalness_all"][level] for p in points] for points in (sabotage, natural)
        )
        if None in low or None in high:
            continue
        gates += [
            Gate("sabotage reads 0", level, max(low), 0.05, at_least=False),
            Gate("largest λ stays natural", level, float(np.mean(high)), 0.7, at_least=True),
        ]
    return gates


def _recipe_gates(
    subject: Subject,
    out: Path,
    sizes: Sizes,
    ends: Mapping[float, Sequence[Mapping[str, Any]]],
    listener: Listener,
) -> list[Gate]:
    task = subject.task
    robot = load_policy(subject.robot, task=task, agent="robot")
    human = load_policy(subject.human, task=task, agent="human")
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
    gates = _at_least("canonical against itself", canonical_splits(pool, bench), 0.97)
    listener.say(f"{SPLITS} splits of canonical episodes are judged")
    gates += _at_least("shuffled labels", label_shuffles(pool[:half], sound[:half], bench), 0.97)
    listener.say(f"{SHUFFLES} shuffles of labels are judged")
    gates += planted_gates([found for part in planted_shifts(pool, bench) for found in part])
    fold = Fold(*np.split(pool[: 3 * sizes.canonical], 3))
    moves = moved_by_company(fold, natural, sabotage, bench)
    gates += [
        Gate(f"moved by {COMPANY} sabotage adversaries", level, move, 0.02, at_least=False)
        for level, move in moves.items()
    ]
    return gates


def planted_gates(planted: Sequence[Planted]) -> list[Gate]:
    """How exactly planted shifts are read, and whether more of a shift ever reads as less.

    Monotone: wherever the exact overlap falls by more than 0.05, the tolerance of one reading, the
    found one has to fall as well.
    """
    gates = []
    for level in dict.fromkeys(found.name for found in planted):
        mine = sorted((p for p in planted if p.name == level), key=lambda p: p.shift)
        error = max(abs(found.found - found.exact) for found in mine)
        rises = [
            after.found - before.found
            for before, after in pairwise(mine)
            if before.exact - after.exact > 0.05
        ]
        gates += [
            Gate("planted shifts, largest error", level, error, 0.05, at_least=False),
            Gate("planted shifts, largest rise", level, max(rises, default=0), 0, at_least=False),
        ]
    return gates


def _at_least(name: str, values: Iterable[Values], limit: float) -> list[Gate]:
    """A gate at each level for the mean over repetitions."""
    found = list(values)
    return [
        Gate(name, level, float(np.mean([value[level] for value in found])), limit, at_least=True)
        for level in found[0]
    ]


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
