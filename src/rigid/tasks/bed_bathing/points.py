"""The points of the arm that are to be wiped, and which of them a touch of the pad wipes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.distance import cdist

from rigid.tasks.bodies import human
from rigid.tasks.bodies.sizes import BodySize

LIMBS: tuple[human.Limb, ...] = ("upper_arm", "forearm")
"""Those with points, in the order of the points."""
SPACING = 0.03
"""Between neighbouring points [m] (Assistive Gym)."""
WIPED_WITHIN = 0.025
"""A touch of the pad so near a point wipes it [m] (Assistive Gym)."""
WIPED_SHARE = 0.3
"""Share of the points that makes a success (Assistive Gym)."""


class ArmPoints(NamedTuple):
    """P points on the skin of an arm."""

    places: Float[np.ndarray, "P 3"]
    """Each in the frame of its limb [m]."""
    limb: Int[np.ndarray, " P"]
    """Index into `LIMBS`."""

    @property
    def enough(self) -> int:
        """How many must be wiped for a success."""
        return int(np.ceil(WIPED_SHARE * len(self.limb) - 1e-9))


def arm_points(size: BodySize) -> ArmPoints:
    """The points of a body's right arm."""
    limbs = [limb_points(*sizes) for sizes in (size.upper_arm, size.forearm)]
    index = np.repeat(np.arange(len(limbs)), [len(places) for places in limbs])
    return ArmPoints(np.concatenate(limbs), index)


def limb_points(radius: float, length: float) -> Float[np.ndarray, "n 3"]:
    """Rings of points around a limb that hangs along -z of its frame (Assistive Gym).

    Rings stand `length` / (rings + 1) apart. The points of one begin at -y, and go on to -x every
    3 cm of its circumference; what is left of it, less than 3 cm more, stays between last and
    first.
    """
    rings = int(length / SPACING)
    heights = -length / (rings + 1) * np.arange(1, rings + 1)
    turns = SPACING / radius * np.arange(int(2 * np.pi * radius / SPACING))
    ring = radius * np.stack([-np.sin(turns), -np.cos(turns)], axis=1)
    places = np.zeros((rings, len(turns), 3))
    places[..., :2], places[..., 2] = ring, heights[:, None]
    return places.reshape(-1, 3)


def wiped_now(
    points: ArmPoints,
    touching: Bool[np.ndarray, "B S L C"],
    places: Float[np.ndarray, "B S L C 3"],
) -> Bool[np.ndarray, "B P"]:
    """Points near any touch of the pad in a control step, wiped before or not.

    Args:
        points: Of the arm.
        touching: Which of the C contacts kept for each limb there are, at each of S physics steps.
        places: Of those contacts, in the frame of the limb [m].
    """
    wiped = np.zeros((len(touching), len(points.limb)), dtype=bool)
    for index in range(len(LIMBS)):
        world, step, contact = np.nonzero(touching[:, :, index])
        if not len(world):
            continue
        mine = np.flatnonzero(points.limb == index)
        gap = cdist(places[world, step, index, contact], points.places[mine])
        touch, point = np.nonzero(gap < WIPED_WITHIN)
        wiped[world[touch], mine[point]] = True
    return wiped
