"""Sizes of the seated human: Assistive Gym's capsule bodies, and how they scale."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar, cast

_Shape = TypeVar("_Shape", bound=tuple[float, ...])  # A radius, then lengths.


@dataclass(frozen=True)
class BodySize:
    """Lengths [m] and mass [kg] of one body; `radius_scale` thickens every capsule."""

    chest_height: float
    chest: tuple[float, float]  # Radius, cylinder length.
    pecs: tuple[float, float, float]  # Radius, length, offset along x.
    pecs_up: float
    neck: tuple[float, float, float, float]  # Radius, length, centre, height over the chest.
    head: tuple[float, float, float, float]  # Half extents x, y, z and height over the neck.
    head_center: tuple[float, float]  # Of the ellipsoid in the head's frame: y, z.
    mouth: tuple[float, float]  # In the head's frame: y, z.
    shoulder_out: float
    upper_arm: tuple[float, float]  # Radius, length to the elbow.
    forearm: tuple[float, float]  # Radius, cylinder length; the wrist is one radius further.
    hand: float
    waist: tuple[float, float, float]  # Radius, length, drop below the chest.
    hips: tuple[float, float, float]
    hip_out: float
    thigh: tuple[float, float]
    shin: tuple[float, float]
    foot: tuple[float, float]
    mass: float

    def scaled(self, stature: float, girth: float) -> BodySize:
        """Returns the body with every length times `stature` and every radius times `girth`.

        The chair keeps its height, so the seat-to-shoulder length grows above it. Who is shorter
        than the reference sits on a cushion, so that the elbow stays above the arm rest (ours).
        """
        hip_drop = self.waist[2] + 2 * self.hips[2]

        def sized(shape: _Shape) -> _Shape:
            radius, *lengths = shape
            return cast("_Shape", (radius * girth, *(length * stature for length in lengths)))

        return BodySize(
            chest_height=self.chest_height + max(stature - 1, 0) * hip_drop,
            chest=sized(self.chest),
            pecs=sized(self.pecs),
            pecs_up=self.pecs_up * stature,
            neck=sized(self.neck),
            head=self.head[:3] + (self.head[3] * stature,),
            head_center=self.head_center,
            mouth=self.mouth,
            shoulder_out=self.shoulder_out * stature,
            upper_arm=sized(self.upper_arm),
            forearm=sized(self.forearm),
            hand=self.hand * girth,
            waist=sized(self.waist),
            hips=sized(self.hips),
            hip_out=self.hip_out * stature,
            thigh=sized(self.thigh),
            shin=sized(self.shin),
            foot=sized(self.foot),
            mass=self.mass * stature * girth**2,
        )


BODIES: dict[str, BodySize] = {
    "male": BodySize(
        chest_height=0.89, chest=(0.127, 0.056), pecs=(0.106, 0.0316, 0.0854), pecs_up=0.07075,
        neck=(0.060, 0.124, 0.09, 0.1515), head=(0.083, 0.097, 0.116, 0.137),
        head_center=(-0.029, 0.081), mouth=(-0.11, 0.03), shoulder_out=0.179,
        upper_arm=(0.043, 0.279), forearm=(0.033, 0.257), hand=0.043,
        waist=(0.1205, 0.049, 0.156), hips=(0.1335, 0.094, 0.08125), hip_out=0.089,
        thigh=(0.080, 0.424), shin=(0.050, 0.403), foot=(0.050, 0.215), mass=78.4,
    ),
    "female": BodySize(
        chest_height=0.86, chest=(0.127, 0.010), pecs=(0.092, 0.0281, 0.0759), pecs_up=0.066,
        neck=(0.050, 0.121, 0.09, 0.132), head=(0.077, 0.0895, 0.1085, 0.120),
        head_center=(-0.0235, 0.0735), mouth=(-0.10, 0.03), shoulder_out=0.159,
        upper_arm=(0.0355, 0.264), forearm=(0.027, 0.234), hand=0.0355,
        waist=(0.110, 0.009, 0.150), hips=(0.127, 0.117, 0.075), hip_out=0.092,
        thigh=(0.0775, 0.391), shin=(0.045, 0.367), foot=(0.045, 0.195), mass=62.5,
    ),
}  # fmt: skip
