"""The shared reward of bed bathing, term by term (Assistive Gym)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.bed_bathing.parameters import RewardWeights
from rigid.tasks.bed_bathing.sensing import Contacts
from rigid.tasks.physics.reward import effort, high_force


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
    return {
        "distance": -weights.distance * distance,
        "wipe": weights.wipe * wiped,
        **effort(weights, action, end_effector_speed),
        "other_force": -weights.other_force * contacts.force_unwanted.mean(axis=1),
        **high_force(weights, contacts.force_pad),
    }
