"""Pictures of shapes, drawn by MuJoCo without a screen.

MuJoCo's own `Renderer` takes its OpenGL from what an environment variable said when `mujoco` was
imported, which is too early for a library: here it is chosen when the first picture is drawn.
"""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from collections.abc import Iterable
from functools import cache
from types import TracebackType
from typing import Any, Final, NamedTuple, final

import mujoco
import numpy as np
from jaxtyping import Float, UInt8

from rigid.errors import UserError
from rigid.report.viewpoint import FIELD_OF_VIEW, Viewpoint

Colour = tuple[float, float, float]
"""Red, green and blue in [0, 1]."""

BACKGROUND: Final[Colour] = (0.965, 0.957, 0.941)
"""The paper of the report, a little darker, so that a light robot stands out."""
_TYPES: Final = {
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
}
_BACKENDS: Final = ("egl", "osmesa")
_TRIAL = "import mujoco.{0}; mujoco.{0}.GLContext(8, 8).make_current()"
_MOST_SHAPES = 2000


class Shape(NamedTuple):
    """One solid to draw, with sizes as MuJoCo has them."""

    type: str
    """capsule, sphere, box, cylinder or ellipsoid."""
    size: Float[np.ndarray, "3"]
    position: Float[np.ndarray, "3"]
    turn: Float[np.ndarray, "3 3"]
    rgba: Float[np.ndarray, "4"]
    glow: float = 0.0
    """How much it shines by itself, in [0, 1]."""


@final
class Canvas:
    """Draws pictures of one size; use as a context manager, since it holds graphics memory."""

    def __init__(self, width: int, height: int) -> None:
        """Takes hold of OpenGL.

        Args:
            width: Of every picture [pixels].
            height: Of every picture [pixels].

        Raises:
            UserError: This machine cannot draw.
        """
        self._gl = _context(width, height)
        self._gl.make_current()
        self._model = _stage(width, height)
        self._data = mujoco.MjData(self._model)
        mujoco.mj_forward(self._model, self._data)
        self._scene = mujoco.MjvScene(self._model, maxgeom=_MOST_SHAPES)
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._scene.flags[flag] = 0
        size = mujoco.mjtFontScale.mjFONTSCALE_100  # Unused: pictures hold no text of MuJoCo's.
        self._context = mujoco.MjrContext(self._model, size)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._option, self._rect = mujoco.MjvOption(), mujoco.MjrRect(0, 0, width, height)

    def __enter__(self) -> Canvas:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._context.free()
        self._gl.free()

    def draw(self, shapes: Iterable[Shape], viewpoint: Viewpoint) -> UInt8[np.ndarray, "h w 3"]:
        """A picture of the shapes; those that are see-through let what was given before show."""
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            self._model, self._data, self._option, None, _camera(viewpoint), everything, self._scene
        )
        for shape in shapes:
            self._add(shape)
        self._gl.make_current()
        picture = np.empty((self._rect.height, self._rect.width, 3), np.uint8)
        mujoco.mjr_render(self._rect, self._scene, self._context)
        mujoco.mjr_readPixels(picture, None, self._rect, self._context)
        return np.flipud(picture)  # OpenGL's first row is the lowest.

    def _add(self, shape: Shape) -> None:
        geom = self._scene.geoms[self._scene.ngeom]
        mujoco.mjv_initGeom(
            geom, _TYPES[shape.type], shape.size, shape.position, shape.turn.ravel(),
            shape.rgba.astype(np.float32),
        )  # fmt: skip
        geom.emission, geom.specular, geom.shininess = shape.glow, 0.15, 0.3
        self._scene.ngeom += 1


def _camera(viewpoint: Viewpoint) -> mujoco.MjvCamera:
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    forward = viewpoint.axes[2]
    camera.lookat[:] = viewpoint.target
    camera.distance = float(np.linalg.norm(viewpoint.target - viewpoint.position))
    camera.azimuth = float(np.rad2deg(np.arctan2(forward[1], forward[0])))
    camera.elevation = float(np.rad2deg(np.arcsin(forward[2])))
    return camera


def _stage(width: int, height: int) -> mujoco.MjModel:
    """A model of nothing but sky and light; it says how large a picture may be."""
    spec = mujoco.MjSpec()
    spec.stat.extent = 1.0  # Lengths below are in metres.
    look = spec.visual
    look.global_.fovy = FIELD_OF_VIEW
    look.global_.offwidth, look.global_.offheight = width, height
    look.quality.offsamples = look.quality.shadowsize = 0  # Neither MSAA nor shadows.
    look.map.znear, look.map.zfar = 0.05, 50.0
    look.quality.numslices, look.quality.numstacks, look.quality.numquads = 28, 16, 4
    look.headlight.ambient, look.headlight.diffuse = (0.5,) * 3, (0.35,) * 3
    look.headlight.specular = (0.0,) * 3
    sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=8, height=8)
    sky.builtin = mujoco.mjtBuiltin.mjBUILTIN_FLAT
    sky.rgb1 = sky.rgb2 = BACKGROUND
    light = spec.worldbody.add_light(dir=(0.35, 0.5, -1.0), diffuse=(0.4,) * 3, castshadow=False)
    light.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    return spec.compile()


def _context(width: int, height: int) -> Any:
    """OpenGL without a screen."""
    name = backend()
    if name is None:
        raise UserError(
            "this machine cannot draw without a screen: neither EGL nor OSMesa works. On Debian "
            "and Ubuntu: sudo apt-get install libegl1 libgl1-mesa-dri libopengl0 (or libosmesa6)"
        )
    return importlib.import_module(f"mujoco.{name}").GLContext(width, height)


@cache
def backend() -> str | None:
    """The first backend that works; what MUJOCO_GL names is the only one tried.

    A process can load one of them only, even one that fails, so each is tried in its own.
    """
    named = os.environ.get("MUJOCO_GL", "").lower()
    candidates = (named,) if named in _BACKENDS else _BACKENDS
    return next((name for name in candidates if _works(name)), None)


def _works(name: str) -> bool:
    environment = {key: value for key, value in os.environ.items() if key != "MUJOCO_GL"}
    # -P: a folder in which RIGID happens to be run is no place to import from.
    trial = [sys.executable, "-P", "-c", _TRIAL.format(name)]
    done = subprocess.run(trial, env=environment, capture_output=True, check=False)
    return done.returncode == 0
