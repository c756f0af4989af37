"""An episode as a film: smooth, in real time, red where the robot touches what it should not.

The paper highlights the touched part of the person in red (appendix, 'More Visualizations of Robot
Failure Cases').
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image, ImageDraw, ImageFont

from rigid.report.canvas import BACKGROUND, Canvas, Colour, Shape
from rigid.report.motion import Motion, carry, half_lengths, placed
from rigid.report.viewpoint import FIELD_OF_VIEW, Viewpoint, viewpoint_for

# The colours of the report's 3D view in the light (web/src/styles/tokens.css).
UNWANTED: Final[Colour] = (0.84, 0.09, 0.04)
"""Redder than the report's, as the paper's is: a film has no legend."""
_ITCH: Final[Colour] = (0.88, 0.58, 0.0)
_ROLES: Final[Mapping[str, Colour]] = {
    "robot": (0.365, 0.400, 0.455),
    "tool": (0.137, 0.149, 0.176),
    "human": (0.847, 0.663, 0.549),
    "chair": (0.788, 0.773, 0.737),
}
_FLOOR: Final[Colour] = (0.885, 0.875, 0.85)
_FLOOR_RADIUS, _FLOOR_HALF = 0.85, 0.004  # [m]
_OWN_SHARE = 0.4
"""How much of a geom's own colour shows through its role's: the report's."""
_INK, _SOFT = (28, 29, 33), (94, 96, 104)
_ITCH_DOT, _ITCH_RING = 0.014, 0.033  # Radii [m], those of the report.
_FINENESS = 2
"""Pictures are drawn so much larger and then reduced: smooth edges without MSAA."""
_HELD, _FADED = 1.0, 2.0
"""A touched part is red so long before and after the frame of the contact [frames], and fades out
until then: contacts are recorded once a frame, and a tenth of a second is easily missed. Ours."""


TITLED = 0.12
"""Share of a picture's height that its title of two lines takes."""


class Take(NamedTuple):
    """One episode, and what to write above it."""

    motion: Motion
    title: str


@dataclass(frozen=True)
class FilmSettings:
    """Size and pace of a film."""

    width: int = 800
    """Of each take [pixels]; takes stand side by side."""
    height: int = 600
    """[pixels]."""
    fps: int = 30
    """Pictures per second."""
    speed: float = 1.0
    """1 is real time, 0.5 half of it."""

    def times(self, motion: Motion) -> Float[np.ndarray, " n"]:
        """The moment [frames] of each picture, from the first frame to the last.

        Example:
            >>> still = np.zeros((3, 1, 7))
            >>> motion = Motion(still, dt=0.1, itch=None, touches=(), force_unwanted=still[:, 0, 0])
            >>> FilmSettings(fps=20).times(motion)
            array([0. , 0.5, 1. , 1.5, 2. ])
        """
        steps = int(np.floor(motion.last * motion.dt * self.fps / self.speed + 1e-9))
        return np.arange(steps + 1) * self.speed / self.fps / motion.dt


def film(
    scene: Mapping[str, Any], takes: Sequence[Take], settings: FilmSettings
) -> Iterator[UInt8[np.ndarray, "h w 3"]]:
    """The pictures of a film, one after the other; all takes are seen from where suits the first.

    Args:
        scene: `rigid.report.payload.Scene`.
        takes: One or more, shown side by side; the first says how long the film is.
        settings: Size and pace.

    Raises:
        UserError: This machine cannot draw.
    """
    first = takes[0].motion
    viewpoint = viewpoint_for(scene, first, aspect=settings.width / settings.height, free=TITLED)
    floor = floor_below(scene, first)
    with Canvas(_FINENESS * settings.width, _FINENESS * settings.height) as canvas:
        for time in settings.times(first):
            halves = []
            for take in takes:
                solid = [floor, *shapes(scene, take.motion, time)]
                picture = canvas.draw(solid, viewpoint)
                halves.append(_finished(picture, take, time, viewpoint))
            yield np.concatenate(halves, axis=1)


def redness(motion: Motion, time: float) -> dict[int, float]:
    """How red the touched geoms are at `time` [frames], in (0, 1]."""
    found: dict[int, float] = {}
    for touch in motion.touches:
        age = time - touch.frame
        strength = 0.0 if age < -_HELD else min(1.0, (_HELD + _FADED - age) / _FADED)
        if strength > 0 and touch.geom >= 0:
            found[touch.geom] = max(strength, found.get(touch.geom, 0.0))
    return found


def shapes(scene: Mapping[str, Any], motion: Motion, time: float) -> list[Shape]:
    """All that is solid at `time` [frames]: the scene's geoms, red where touched, and the itch."""
    poses, red = motion.at(time), redness(motion, time)
    where = placed(scene, poses)
    solid = []
    for index, geom in enumerate(scene["geoms"]):
        if geom["role"] == "floor":
            continue
        share = red.get(index, 0.0)
        rgb = (1 - share) * _colour(geom) + share * np.array(UNWANTED)
        rgba = np.append(rgb, geom["rgba"][3])
        size = np.resize(np.append(geom["size"], (0.0, 0.0, 0.0)), 3)
        solid.append(
            Shape(geom["type"], size, where.positions[index], where.turns[index], rgba, share / 3)
        )
    if motion.itch is not None:
        at = carry(poses[motion.itch.body], motion.itch.pos)
        size = np.array([_ITCH_DOT, 0.0, 0.0])
        solid.append(Shape("sphere", size, at, np.eye(3), np.array([*_ITCH, 1.0]), 0.5))
    return solid


def _colour(geom: Mapping[str, Any]) -> Float[np.ndarray, "3"]:
    """That of the geom's role, tinted by its own."""
    own = np.array(geom["rgba"][:3], float)
    role = _ROLES.get(geom["role"])
    return own if role is None else (1 - _OWN_SHARE) * np.array(role) + _OWN_SHARE * own


def floor_below(scene: Mapping[str, Any], motion: Motion) -> Shape:
    """A round floor on which stands whatever is lowest at the start."""
    where = placed(scene, motion.at(0.0))
    lowest = min(
        position[2] - float(np.abs(turn[2]) @ half_lengths(geom))
        for geom, position, turn in zip(scene["geoms"], *where, strict=True)
    )
    middle = where.positions.mean(axis=0)
    size = np.array([_FLOOR_RADIUS, _FLOOR_HALF, 0.0])
    at = np.array([middle[0], middle[1], lowest - _FLOOR_HALF])
    return Shape("cylinder", size, at, np.eye(3), np.array([*_FLOOR, 1.0]))


def _finished(
    picture: UInt8[np.ndarray, "H W 3"], take: Take, time: float, viewpoint: Viewpoint
) -> UInt8[np.ndarray, "h w 3"]:
    """The picture at its final size, with the itch ringed and what there is to read."""
    image = Image.fromarray(picture)
    _ring(image, take.motion, time, viewpoint)
    image = image.reduce(_FINENESS)
    pen = ImageDraw.Draw(image)
    margin = max(image.height // 30, 4)
    # Haloed, since a raised arm may be behind it.
    look: Any = {"font": _font(margin), "stroke_width": 2, "stroke_fill": _bytes(BACKGROUND)}
    pen.text((margin, margin), take.title, fill=_INK, **look)
    right, low = image.width - margin, image.height - margin
    pen.text((margin, low), f"{time * take.motion.dt:.1f} s", fill=_SOFT, anchor="ls", **look)
    if take.motion.force_unwanted[int(np.ceil(time - 1e-9))] > 0:
        pen.text((right, low), "unwanted contact", fill=_bytes(UNWANTED), anchor="rs", **look)
    return np.asarray(image)


def _bytes(colour: Colour) -> tuple[int, ...]:
    return tuple(round(255 * share) for share in colour)


def _ring(image: Image.Image, motion: Motion, time: float, viewpoint: Viewpoint) -> None:
    """Rings the itch, which a limb may hide."""
    if motion.itch is None:
        return
    at = carry(motion.at(time)[motion.itch.body], motion.itch.pos)
    ((x, y),) = viewpoint.project(at[None], image.width, image.height)
    depth = float((at - viewpoint.position) @ viewpoint.axes[2])
    radius = _ITCH_RING * image.height / 2 / np.tan(np.deg2rad(FIELD_OF_VIEW / 2)) / depth
    box = (x - radius, y - radius, x + radius, y + radius)
    ImageDraw.Draw(image).ellipse(box, outline=_bytes(_ITCH), width=max(2, image.height // 300))


@cache
def _font(size: int) -> ImageFont.FreeTypeFont:
    """DejaVu Sans, which knows Greek; it comes with matplotlib."""
    import matplotlib as mpl

    return ImageFont.truetype(Path(mpl.get_data_path()) / "fonts/ttf/DejaVuSans.ttf", size)
