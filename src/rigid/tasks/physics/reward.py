"""Terms that the reward of every assistive task has (Assistive Gym)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from rigid.tasks.physics.parameters import Weights

HIGH_FORCE = 10.0
"""From this force of the tool on, contact hurts [N] (Assistive Gym)."""


def effort(
    weights: Weights, action: Float[np.ndarray, "B a"], end_effector_speed: Float[np.ndarray, " B"]
) -> dict[str, Float[np.ndarray, " B"]]:
    """What moving costs.

    Args:
        weights: Of the task.
        action: Clipped actions of robot and human, joined.
        end_effector_speed: [m/s].
    """
    return {
        "action": -weights.action * np.linalg.norm(action, axis=1),
        "velocity": -weights.velocity * end_effector_speed,
    }


def high_force(
    weights: Weights, force: Float[np.ndarray, "B S"]
) -> dict[str, Float[np.ndarray, " B"]]:
    """What hurting costs.

    Args:
        weights: Of the task.
        force: Of the tool where it belongs, at each of S physics steps [N].
    """
    peak = force.max(axis=1)
    return {"high_force": -weights.high_force * np.where(peak >= HIGH_FORCE, peak, 0.0)}
