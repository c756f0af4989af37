"""The shared reward of itch scratching, term by term (Assistive Gym and the paper's appendix B)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.itch_scratching.parameters import RewardWeights
from rigid.tasks.itch_scratching.sensing import Contacts
from rigid.tasks.physics.reward import HIGH_FORCE, effort, high_force

MOVED = 0.01
"""A contact counts again once its point has moved this far in the world [m] (Assistive Gym)."""
SUCCESS_CONTACTS = 25
"""Counted contacts of a helped episode (paper, section 5)."""


def counted_contacts(
    contacts: Contacts, last_counted: Float[np.ndarray, "B 3"]
) -> Bool[np.ndarray, " B"]:
    """Whether this control step adds a counted contact: at the itch, moved, and not too hard.

    Contacts of every physics step are looked at (the original looks at the last one only), and at
    most one is counted in a control step. From `HIGH_FORCE` on none is.
    """
    moved = np.linalg.norm(contacts.itch_contact - last_counted, axis=1) > MOVED
    gentle = contacts.force_itch.max(axis=1) < HIGH_FORCE
    counted: np.ndarray = contacts.itch_touched & moved & gentle
    return counted


def reward_terms(
    weights: RewardWeights,
    *,
    distance: Float[np.ndarray, " B"],
    counted: Bool[np.ndarray, " B"],
    action: Float[np.ndarray, "B a"],
    end_effector_speed: Float[np.ndarray, " B"],
    contacts: Contacts,
) -> dict[str, Float[np.ndarray, " B"]]:
    """The named terms of one control step; their sum is the reward.

    Args:
        weights: Weight of each term.
        distance: Tip to itch [m].
        counted: Steps with a counted contact.
        action: Clipped actions of robot and human, joined.
        end_effector_speed: [m/s].
        contacts: Contacts of the step; forces enter as means over its physics steps.
    """
    at_itch = contacts.force_itch.mean(axis=1)
    elsewhere = np.maximum(contacts.force_on_person.mean(axis=1) - at_itch, 0.0)
    return {
        "distance": -weights.distance * distance,
        "scratch": weights.scratch * counted,
        **effort(weights, action, end_effector_speed),
        "other_force": -weights.other_force * elsewhere,
        **high_force(weights, contacts.force_itch),
        "unwanted_contact": -weights.unwanted_contact * contacts.touched_unwanted,
    }
