"""The shared reward of feeding, term by term (Assistive Gym)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.feeding.parameters import RewardWeights
from rigid.tasks.feeding.sensing import Contacts
from rigid.tasks.physics.reward import effort, high_force


class FoodEvents(NamedTuple):
    """Pieces of food to which something happened in a control step."""

    eaten: Int[np.ndarray, " B"]
    spilled: Int[np.ndarray, " B"]
    on_person: Int[np.ndarray, " B"]
    """Those of the spilled that fall on the person."""


def reward_terms(
    weights: RewardWeights,
    *,
    distance: Float[np.ndarray, " B"],
    food: FoodEvents,
    action: Float[np.ndarray, "B a"],
    end_effector_speed: Float[np.ndarray, " B"],
    spoon_speed: Float[np.ndarray, " B"],
    contacts: Contacts,
) -> dict[str, Float[np.ndarray, " B"]]:
    """The named terms of one control step; their sum is the reward.

    Args:
        weights: Weight of each term.
        distance: Spoon to mouth [m].
        food: What happened to the food.
        action: Clipped actions of robot and human, joined.
        end_effector_speed: [m/s].
        spoon_speed: [m/s]: that of food as it is eaten.
        contacts: Contacts of the step; forces enter as means over its physics steps.
    """
    return {
        "distance": -weights.distance * distance,
        "food": weights.food * food.eaten,
        "spill": -weights.spill * food.spilled,
        "food_hit": -weights.food_hit * food.on_person,
        "food_speed": -weights.food_speed * food.eaten * spoon_speed,
        **effort(weights, action, end_effector_speed),
        "force": -weights.force * contacts.force_on_person.mean(axis=1),
        **high_force(weights, contacts.force_spoon),
    }
