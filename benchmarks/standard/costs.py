"""What a curve costs with each preset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from benchmarks.paired import Row, find
from benchmarks.standard.pairing import POOLED, Measured
from benchmarks.standard.plan import CURVE_SEEDS
from rigid.frontier.result import Frontier

_SPENT = ("core_seconds", "env_steps", "env_steps_scoring")
"""Fields of `frontier.json` that add up over seeds."""


def cost_rows(measured: Mapping[str, Measured]) -> list[Row]:
    """A row for each robot and preset, then the means over robots that have pairs.

    Everything is of a curve of `CURVE_SEEDS` seeds, from the seeds that both presets have: those of
    a pair were most likely measured on the same machine.

    Args:
        measured: What is there, by robot.
    """
    rows = []
    for robot, presets in measured.items():
        common = set.intersection(*map(set, presets.values())) if len(presets) == 2 else set()
        rows += [
            _row(robot, preset, [runs[seed] for seed in sorted(common)])
            for preset, runs in presets.items() if common
        ]  # fmt: skip
    return [*rows, *(_mean(rows, preset) for preset in ("standard", "paper") if rows)]


def ratio(rows: Sequence[Row], robot: str) -> float | None:
    """Core-seconds of `paper` over those of `standard`; None where none were counted."""
    paper, standard = (
        find(rows, robot=robot, preset=preset)["core_seconds"] for preset in ("paper", "standard")
    )
    return float(paper / standard) if standard > 0 else None


def _row(robot: str, preset: str, frontiers: Sequence[Frontier]) -> Row:
    seeds = len(frontiers)
    spent = {
        name: CURVE_SEEDS * sum(run.data[name] for run in frontiers) / seeds for name in _SPENT
    }
    return {"robot": robot, "preset": preset, "seeds": seeds, **_whole(spent)}


def _mean(rows: Sequence[Row], preset: str) -> Row:
    mine = [row for row in rows if row["preset"] == preset]
    spent = {name: sum(row[name] for row in mine) / len(mine) for name in _SPENT}
    seeds = sum(row["seeds"] for row in mine)
    return {"robot": POOLED, "preset": preset, "seeds": seeds, **_whole(spent)}


def _whole(spent: Mapping[str, float]) -> dict[str, float]:
    """Steps without fractions, so that the table keeps all of their digits."""
    return {
        name: value if name == "core_seconds" else round(value) for name, value in spent.items()
    }
