"""Searches with points set by hand."""

from __future__ import annotations

from pathlib import Path

from benchmarks.measures.plan import AGAIN_SHIFT, Plan, Search
from benchmarks.measures.searching import Searched
from rigid.frontier.result import Frontier
from rigid.presets import PRESETS

PLAN = Plan(preset=PRESETS["demo"], measures=("lsgan", "mmd", "ensemble"), command="a command")


def point(seed, number, x, y, *, faults=0):
    return {
        "id": f"s{seed}-r1-l{number}", "seed": seed, "round": 1, "lambda": 0.1, "naturalness": x,
        "naturalness_se": 0.01, "naturalness_own": None, "adversarialness": y, "success": 0.5,
        "faults": faults, "episodes": 10, "converged": True, "env_steps": 800,
    }  # fmt: skip


def searched(name, pairs_by_seed, *, measure=None, shift=0, anchor=0.0):
    points = [
        point(seed + shift, number, x, y)
        for seed, pairs in pairs_by_seed.items()
        for number, (x, y) in enumerate(pairs, 1)
    ]
    data = {
        "canonical": {"adversarialness": anchor},
        "points": points,
        "auc_by_seed": {str(seed + shift): 0.0 for seed in pairs_by_seed},
        "core_seconds": 60.0,
    }
    return Searched(Search(name, measure or name, shift), Frontier(Path("nowhere"), data))


def study():
    """Two seeds; `mmd` alone finds a natural attack, `ensemble` nothing of its own."""
    plain = {seed: [(0.0, 1.0), (0.5, 0.5)] for seed in (0, 1)}
    found = [
        searched("lsgan", plain),
        searched("mmd", {seed: [(0.0, 1.0), (0.9, 0.6)] for seed in (0, 1)}),
        searched("ensemble", {seed: [(0.0, 0.9), (0.5, 0.48)] for seed in (0, 1)}),
        searched("lsgan-again", plain, measure="lsgan", shift=AGAIN_SHIFT),
        searched("ensemble-again", plain, measure="ensemble", shift=AGAIN_SHIFT),
    ]
    return {one.search.name: one for one in found}
