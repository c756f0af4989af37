"""The shared reward of bed bathing, term by term (Assistive Gym)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.bed_bathing.parameters import RewardWeights
from rigid.tasks.bed_bathing.sensing import Contacts

HIGH_FORCE = 10.0
"""From this force of the pad on, contact hurts [N] (Assistive Gym)."""


def reward_terms(
    weights: RewardWeights,
    *,
    distance: Float[np.ndarray, " B"],
    wiped: Int[np.ndarray, " B"],
    action: Float[np.ndarray, "B a"],
    end_effector_speed: Float[np.ndarray, " B"],
    contacts: Contacts,
) -> dict[str, Float[np.ndarray, " B"]]:
    """The named terms of one control step; their sum is the reward.

    Args:
        weights: Weight of each term.
        distance: Pad to arm [m].
        wiped: Points that were wiped for the first time.
        action: Clipped actions of robot and human, joined.
        end_effector_speed: [m/s].
        contacts: Contacts of the step; forces enter as means over its physics steps.
    """
    peak = contacts.force_pad.max(axis=1)
    return {
        "distance": -weights.distance * distance,
        "wipe": weights.wipe * wiped,
        "action": -weights.action * np.linalg.norm(action, axis=1),
        "velocity": -weights.velocity * end_effector_speed,
        "other_force": -weights.other_force * contacts.force_unwanted.mean(axis=1),
        "high_force": -weights.high_force * np.where(peak >= HIGH_FORCE, peak, 0.0),
    }
