"""The verdict on a referee: gates, each a number that was measured and what it has to be."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from rigid.compute.run.provenance import provenance
from rigid.naturalness.gates import Planted, Values
from rigid.naturalness.panel import AXIS, LEVEL_NAMES


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


def ends_gates(
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


def at_least(name: str, values: Iterable[Values], limit: float) -> list[Gate]:
    """A gate at each level for the mean over repetitions."""
    found = list(values)
    return [
        Gate(name, level, float(np.mean([value[level] for value in found])), limit, at_least=True)
        for level in found[0]
    ]
