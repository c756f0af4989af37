"""Parts of the study set by hand: finer steps differ less, and only free swings gain energy."""

from __future__ import annotations

import numpy as np

from benchmarks.physics.plan import (
    AGED,
    FINEST,
    PAIRS,
    QUICK,
    SETTINGS,
    SPEEDS,
    SWINGS,
    WINDOW_REFERENCE,
)
from benchmarks.physics.tables import part_name

EPISODES = 500
PLAN = QUICK


def closed(step, *, shift=0.0, episodes=EPISODES):
    """Episodes whose return is moved by `shift`, and forces by as many percent as `step` has cs."""
    rng = np.random.default_rng(0)
    force = rng.uniform(10, 20, episodes) * (1 + step)
    return {
        "return": (rng.normal(400, 20, episodes) + shift).tolist(),
        "success": [1.0] * episodes,
        "counted": [90] * episodes,
        "peak_force": force.tolist(),
        "impulse": force.tolist(),
        "penetration": (1e-3 + 0.01 * step * rng.uniform(0.9, 1.1, episodes)).tolist(),
        "fastest": [0.8] * episodes,
        "faulted": [0.0] * episodes,
        "angles": [[step] * 10] * episodes,
    }


def window(step, episodes=6):
    """Episodes with four windows of touch each; the last has none. Errors are the step."""
    rng = np.random.default_rng(1)
    touched = [4.0] * (episodes - 1) + [0.0]
    force = rng.uniform(4, 5, episodes) * (1 + 20 * (step - 0.001)) * (np.array(touched) > 0)
    errors = (step - 0.001) * rng.uniform(0.9, 1.1, episodes)
    return {
        "touched": touched, "impulse": (force / 10).tolist(), "peak_force": force.tolist(),
        "impulse_error": errors.tolist(), "penetration": (force * 1e-4).tolist(),
        "angles": errors.tolist(), "angles_rad": errors.tolist(), "features": errors.tolist(),
    }  # fmt: skip


def softness(stiffness=692.5):
    return {"constraints": 10, "stiffness": [stiffness] * 2, "damping": [52.6, 52.6]}


def parts(**closed_shifts):
    """Every part; `shift` of the return at the coarsest step by pair."""
    made = {"cost": {one.name: [0.02 / one.step, 0.021 / one.step] for one in SETTINGS}}
    everything = (*SETTINGS, WINDOW_REFERENCE)
    for pair in PAIRS:
        for one in SETTINGS:
            shift = closed_shifts.get(pair, 0.0) if one == SETTINGS[0] else 0.0
            made[part_name("closed", pair, one)] = closed(one.step, shift=shift)
        made[part_name("windows", pair)] = {
            "settings": {one.name: window(one.step) for one in everything},
            "softness": {one.name: softness() for one in everything},
            "touched": 0.5,
        }
    for pair in AGED:
        made[part_name("aged", pair)] = closed(FINEST.step, shift=closed_shifts.get(pair, 0.0) / 4)
    for swing in SWINGS:
        gain = 2.0 if swing == "free" else 0.0
        made[part_name("energy", swing)] = {
            f"{speed:g}": {one.name: [gain * one.step, 1.1 * gain * one.step] for one in SETTINGS}
            for speed in SPEEDS
        }
    return made
