"""A made-up frontier for the report: plausible in shape, measured nowhere.

`python tests/report/sample_payload.py OUT.html` writes the page, to look at.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))  # So that it runs as a script and under importlib.
from synthetic_motion import FRAMES, episode, moments, scene

from rigid.report import build_report
from rigid.report.episodes import read_episode
from rigid.report.failure_rules import classify
from rigid.report.failures import group

CANONICAL_Y = 0.06
GRID = np.linspace(0, 1, 101)
T_95 = {2: 12.706, 3: 4.303, 4: 3.182, 8: 2.365}  # Student's t of n seeds, two-sided.


def _point(rng, seed, round_, index, lambda_):
    finite = 1e4 if lambda_ == "inf" else max(lambda_, 1e-4)
    x = 1 / (1 + np.exp(-1.9 * (np.log10(finite) + 0.9))) * 0.99 + rng.normal(0, 0.035)
    x = float(np.clip(x, 0.01, 0.995))
    y = CANONICAL_Y + (0.93 - 0.1 * seed % 0.3) * (1 - x**2.6) ** 0.8 * rng.uniform(0.62, 1.0)
    y = float(np.clip(y, 0.02, 1))
    unwanted = float(np.clip(y * rng.uniform(0.55, 0.9), 0, 1))
    helped = float(np.clip((1 - y) * rng.uniform(0.85, 1), 0, 1 - unwanted))
    outcomes = {"helped": helped, "unhelped": 1 - helped - unwanted, "unwanted_contact": unwanted}
    levels = {
        "step_k1": max(0.0, x * 0.7 - 0.04), "step_k4": x, "window16_k1": max(0.0, 0.25 * x - 0.02),
        "window16_k4": 0.45 * x, "window16_k16": 0.75 * x,
    }  # fmt: skip
    return {
        "id": f"s{seed}-r{round_}-l{index}", "seed": seed, "round": round_, "lambda": lambda_,
        "naturalness": x, "naturalness_own": float(np.clip(x + rng.normal(0.03, 0.04), 0, 1)),
        "naturalness_all": levels, "adversarialness": y, "return": 20 - 120 * y, "success": helped,
        "episodes": 200, "env_steps": 576_000,
        "outcomes": outcomes, "peak_force": 4 + 24 * y * rng.uniform(0.7, 1.2), "impulse": 9 * y,
        "faults": int(rng.random() < 0.1), "converged": bool(rng.random() < 0.93),
        "on_frontier": False,
    }  # fmt: skip


def _points(rng, seeds):
    rounds = ([0, 0.01, 0.1, 1.0, 10.0, "inf"], [0.018, 0.032, 0.056, 0.18, 0.32, 0.56], None)
    points = []
    for seed in range(seeds):
        for number, lambdas in enumerate(rounds, 1):
            chosen = lambdas or sorted(10 ** rng.uniform(-0.9, 0.6, 6))
            chosen = [v if isinstance(v, str) else float(v) for v in chosen]
            points += [_point(rng, seed, number, i, v) for i, v in enumerate(chosen)]
    for p in points:
        p["on_frontier"] = not any(
            q["naturalness"] >= p["naturalness"] and q["adversarialness"] >= p["adversarialness"]
            for q in points if q is not p
        )  # fmt: skip
    return points


def _hull(points):
    """The upper hull on GRID, with the canonical anchor."""
    xy = [(p["naturalness"], p["adversarialness"]) for p in points] + [(1.0, CANONICAL_Y)]
    xy.append((0.0, max(y for _, y in xy)))
    hull = []
    for p in sorted(xy, key=lambda p: (p[0], -p[1])):
        while len(hull) > 1 and (hull[-1][0] - hull[-2][0]) * (p[1] - hull[-2][1]) >= (
            hull[-1][1] - hull[-2][1]
        ) * (p[0] - hull[-2][0]):
            hull.pop()
        hull.append(p)
    return np.interp(GRID, *np.array(hull).T)


def _interval(values):
    if len(values) < 2:
        return None
    half = T_95[len(values)] * np.std(values, ddof=1) / np.sqrt(len(values))
    return [float(max(0, np.mean(values) - half)), float(min(1, np.mean(values) + half))]


def _frontier(points, seeds):
    by_seed = [[p for p in points if p["seed"] == s] for s in range(seeds)]
    hulls = np.array([_hull(own) for own in by_seed])
    areas = hulls.mean(axis=1)
    natural = hulls[:, 80:].mean(axis=1)

    def worst(threshold):
        natural = [[p for p in own if p["naturalness"] >= threshold] for own in by_seed]
        return [max((p["adversarialness"] for p in own), default=CANONICAL_Y) for own in natural]

    band = {"x": GRID, "mean": hulls.mean(axis=0), "low": None, "high": None}
    if seeds > 1:
        limits = np.array([_interval(column) for column in hulls.T])
        band |= {"low": limits[:, 0], "high": limits[:, 1]}
    thresholds = ("0.8", "0.9", "0.95")
    frontier = {
        "schema": 1, "task": "itch-scratching", "robot": "builtin:vanilla", "preset": "standard",
        "canonical": {"success": 0.97, "return": 12.8, "adversarialness": CANONICAL_Y,
                      "episodes": 200, "source": "synthetic"},
        "points": points, "worst_at": {t: float(np.mean(worst(float(t)))) for t in thresholds},
        "worst_at_by_seed": {
            t: {str(s): y for s, y in enumerate(worst(float(t)))} for t in thresholds
        },
        "worst_at_interval": {t: _interval(worst(float(t))) for t in thresholds},
        "auc_natural": natural.mean(), "auc_natural_interval": _interval(natural),
        "auc": areas.mean(), "auc_interval": _interval(areas),
        "auc_by_seed": {str(s): a for s, a in enumerate(areas)}, "auc_pooled": _hull(points).mean(),
        "auc_staircase": areas.mean() - 0.06, "auc_linear": areas.mean() - 0.03, "auc_excess": 0.11,
        "auc_paper_axis": areas.mean() + 0.02, "return_range": [-100.0, 20.0],
        "range_source": "task", "env_steps": 576_000 * len(points), "env_steps_scoring": 1_000_000,
        "core_seconds": 2300.0, "wall_seconds": 1200.0,
    }  # fmt: skip
    return frontier, band


def _learning(rng, point):
    k = np.arange(1, 121)
    settle = 1 - np.exp(-k / 28)
    gap = 1 - point["naturalness"]
    noise = rng.normal(0, 1, (6, k.size))
    return {
        "iteration": k, "return": 13 + (point["return"] - 13) * settle + 2.5 * noise[0],
        "score_canonical": -0.25 - 0.6 * gap * settle + 0.03 * noise[1],
        "score_adversary": -0.2 + 1.1 * gap * settle + 0.05 * noise[2],
        "accuracy_canonical": np.clip(0.55 + 0.42 * gap * settle + 0.02 * noise[3], 0, 1),
        "accuracy_adversary": np.clip(0.5 + 0.48 * gap * settle + 0.02 * noise[4], 0, 1),
        "entropy": -2 - 3 * settle + 0.05 * noise[5],
    }  # fmt: skip


def _discriminators(rng, points):
    """By seed; the more natural a human, the sooner noise confuses its discriminator."""
    levels = [0.0, 0.1, 0.3, 1.0, 3.0, 10.0]
    poses, found = 6, {}
    for seed in sorted({p["seed"] for p in points}):
        own = [p for p in points if p["seed"] == seed]
        clips = {p["id"]: moments(seed, 1 - p["naturalness"], poses) for p in own}
        judged = {p["id"]: _judged(rng, p, own, levels, poses) for p in own}
        found[str(seed)] = {
            "levels": levels, "canonical_episodes": 40, "adversary_episodes": 20, "judged": judged,
            "poses": {"levels": levels[::2], "noisy": moments(seed, 0.4, 3 * poses), "own": clips},
        }  # fmt: skip
    return found


def _judged(rng, point, mates, levels, poses):
    def accuracy(leniency):
        fall = leniency * (0.5 - 0.3 * (1 - point["naturalness"]))
        canonical = [1 - fall * level / (level + 1) for level in levels]
        return {
            "canonical": canonical,
            "adversaries": {m["id"]: 1 - m["naturalness"] for m in mates},
        }

    scores = {"noisy": rng.normal(-0.4, 0.6, (3, poses)), "own": rng.normal(0.4, 0.6, poses)}
    return {"discriminator": accuracy(1.0), "referee": accuracy(0.8), "scores": scores}


def _tell_failures(stage, motions, points):
    """Adds to each human's episodes what went wrong in them."""
    for point in points:
        for clip in motions[point["id"]].values():
            beside = read_episode(stage, motions["canonical"][str(clip["seed"])])
            clip["failure"] = classify(read_episode(stage, clip), beside)


def sample_payload(seeds: int = 3, *, replays: int | None = None) -> dict:
    """A payload with 18 points per seed; `replays` of them have motions, worst natural first."""
    rng = np.random.default_rng(7)
    points = _points(rng, seeds)
    frontier, band = _frontier(points, seeds)
    moved = sorted(points, key=lambda p: (p["naturalness"] < 0.8, -p["adversarialness"]))[:replays]
    motions = {"canonical": {}, "passive": episode(11, 0.0)}
    for index, point in enumerate(moved):
        worst, median = 2 * index + 1, 2 * index + 2
        motions[point["id"]] = {
            "worst": episode(worst, min(1.0, point["adversarialness"] * 1.3)),
            "median": episode(median, 0.6 * point["adversarialness"]),
        }
        motions["canonical"] |= {str(s): episode(s, 0.0) for s in (worst, median)}
    stage = scene()
    _tell_failures(stage, motions, moved)
    return {
        "frontier": frontier, "band": band, "scene": stage, "replays": motions,
        "failures": group(moved, motions, "itch"),
        "settings": {
            "note": "synthetic sample for the report's tests: measured nowhere",
            "preset": "standard", "seeds": list(range(seeds)),
            "command_line": "rigid frontier --task itch-scratching",
            "versions": {"rigid": "0.1.0", "mujoco": "3.17.0", "jax": "0.10.2"},
            "task": {"name": "itch-scratching", "servo": "paper", "horizon": FRAMES - 1},
            "hashes": {"robot": "sha256:0f3a…", "canonical": "sha256:77c1…"}, "git_commit": None,
        },
        "lacking": None,
        "stamp": "synthetic sample: not a measurement",
        "passive": {"naturalness": 0.34, "adversarialness": 0.31, "success": 0.45, "return": -17.2},
        "learning": {p["id"]: _learning(rng, p) for p in points},
        "discriminators": _discriminators(rng, points),
    }  # fmt: skip


if __name__ == "__main__":
    build_report(sample_payload(), Path(sys.argv[1]))


def worst_natural(payload):
    """Id of the human that does most harm at naturalness 0.8 and more."""
    natural = [p for p in payload["frontier"]["points"] if p["naturalness"] >= 0.8]
    return max(natural, key=lambda p: p["adversarialness"])["id"]
