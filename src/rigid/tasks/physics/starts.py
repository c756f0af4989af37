"""Where episodes begin: collision-free poses of the robot, solved once and stored with a task.

The original draws a goal for the end effector and solves inverse kinematics with random restarts at
every reset (up to seconds each). Ours solves it once, on one branch of the arm, from recorded
seeds; `python -m rigid.tasks.TASK.starts` rewrites a task's `starts.npz`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import kinematics

COUNT = 256
_FILE = "starts.npz"
_SEED = 20231106  # Ours: any fixed number.


@dataclass(frozen=True, kw_only=True)
class Starts:
    """The starts of one task, joint angles of the Jaco [rad]."""

    package: str
    """Which holds them."""
    goal: Float[np.ndarray, "3"]
    """End effector at the start [m], world frame."""
    rotation: Rotation
    """Of the end effector there."""
    spread: float = 0.05
    """Half width of the box around the goal [m] (Assistive Gym)."""
    person: Mapping[str, float] = field(default_factory=dict)
    """The person's joint angles [rad] by name, where they are not 0."""

    def kinematics(self, model: mujoco.MjModel) -> kinematics.ArmKinematics:
        """The Jaco beside the person as an episode begins."""
        return kinematics.ArmKinematics(model, rotation=self.rotation, person=self.person)

    def solve(self, spec: mujoco.MjSpec, count: int, seed: int) -> Float[np.ndarray, "n 7"]:
        """Solves `count` clear starts on one branch of the arm; the scene's margins change."""
        for geom in spec.geoms:
            geom.margin = kinematics.CLEARANCE
        arm, rng = self.kinematics(spec.compile()), np.random.default_rng(seed)
        return kinematics.solve_near(arm, self.goal, self.spread, count, rng)

    def stored(self) -> Float[np.ndarray, "n 7"]:
        """The starts that ship with the package."""
        return _stored(self.package)

    def clear(self, model: mujoco.MjModel) -> Float[np.ndarray, "n 7"]:
        """The stored starts that touch nothing in `model` (larger bodies rule some out)."""
        return kinematics.clear_poses(self.kinematics(model), self.stored())

    def store(self, spec: mujoco.MjSpec, folder: Path) -> None:
        """Solves the starts again, into the package's `folder`."""
        angles = self.solve(spec, COUNT, _SEED)
        np.savez_compressed(folder / _FILE, angles=angles.astype(np.float32))


@cache
def _stored(package: str) -> Float[np.ndarray, "n 7"]:
    with resources.as_file(resources.files(package) / _FILE) as path, np.load(path) as file:
        return np.asarray(file["angles"], dtype=np.float64)
