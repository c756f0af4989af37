"""Adversaries and readings set by hand."""

from __future__ import annotations

from benchmarks.ablations.humans import CANONICAL


def point(seed, lambda_, x, y, **changes):
    return {
        "seed": seed, "lambda": lambda_, "naturalness": x, "adversarialness": y, "faults": 0,
        "episodes": 100, "converged": True, "accuracy_canonical": 1.0, "accuracy_adversary": 0.5,
        **changes,
    }  # fmt: skip


def adversaries(shift=0.0):
    """Two seeds of two λ: sabotage, and a natural human who costs the robot `shift` more."""
    return [
        point(seed, lambda_, *pair)
        for seed in (0, 1)
        for lambda_, pair in ((0.1, (0.0, 0.8)), (1.0, (0.5, 0.5 + shift + 0.001 * seed)))
    ]


def readings(sizes=(5, 10)):
    return [
        {"judge": judge, "human": human, "episodes": n, "repeat": repeat,
         "naturalness": 1.0 if human == CANONICAL else 1 / n, "canonical_passed": 0.9}
        for judge in ("discriminator", "referee")
        for human in ("passive", CANONICAL)
        for n in sizes
        for repeat in (0, 1)
    ]  # fmt: skip
