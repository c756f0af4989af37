"""Where an episode begins: 256 collision-free poses of the robot, solved once and stored.

`python -m rigid.tasks.feeding.starts` rewrites `starts.npz` from a recorded seed.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import kinematics
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.scene import build_spec

GOAL = np.array([-0.15, -0.65, 1.15])
"""End effector at the start [m], world frame: over the bowl (Assistive Gym, reset)."""
GOAL_SPREAD = 0.05
"""Half width of the box around it [m]."""
GOAL_ROTATION = Rotation.from_euler("xyz", (np.pi / 2, 0, np.pi / 2))
"""The palm points along +x, the spoon along +y to the person, its bowl up."""
COUNT = 256
_SEED = 20231106  # Ours: any fixed number.


def arm_kinematics(model: mujoco.MjModel) -> kinematics.ArmKinematics:
    """The Jaco in front of a person who looks straight ahead."""
    return kinematics.ArmKinematics(model, rotation=GOAL_ROTATION, person={})


def solve_starts(parameters: FeedingParameters, count: int, seed: int) -> np.ndarray:
    """Joint angles [rad] of `count` clear starts, shape (count, 7), on one branch."""
    spec = build_spec(parameters)
    for geom in spec.geoms:
        geom.margin = kinematics.CLEARANCE
    arm, rng = arm_kinematics(spec.compile()), np.random.default_rng(seed)
    return kinematics.solve_near(arm, GOAL, GOAL_SPREAD, count, rng)


@cache
def stored_starts() -> Float[np.ndarray, "256 7"]:
    """The starts that ship with the package, joint angles [rad]."""
    source = resources.files("rigid.tasks.feeding") / "starts.npz"
    with resources.as_file(source) as path, np.load(path) as file:
        return np.asarray(file["angles"], dtype=np.float64)


def clear_starts(model: mujoco.MjModel) -> Float[np.ndarray, "n 7"]:
    """The stored starts that touch nothing in `model`."""
    return kinematics.clear_poses(arm_kinematics(model), stored_starts())


if __name__ == "__main__":
    angles = solve_starts(FeedingParameters(), COUNT, _SEED)
    np.savez_compressed(Path(__file__).with_name("starts.npz"), angles=angles.astype(np.float32))
