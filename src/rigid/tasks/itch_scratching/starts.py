"""Where an episode begins: 256 collision-free poses of the robot, solved once and stored.

The original draws a goal for the end effector and solves inverse kinematics with random restarts at
every reset (up to seconds each). Ours solves it once, on one branch of the arm, from recorded
seeds: `python -m rigid.tasks.itch_scratching.starts` rewrites `starts.npz`.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import human, kinematics
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.scene import build_spec

GOAL = np.array([-0.6, 0.0, 0.8])
"""End effector at the start [m], world frame (Assistive Gym, reset)."""
GOAL_SPREAD = 0.05
"""Half width of the box around it [m]."""
GOAL_ROTATION = Rotation.from_euler("y", np.pi / 2)
"""The palm points along +x, at the person's right arm."""
COUNT = 256
_SEED = 20231106  # Ours: any fixed number.


class ArmKinematics(kinematics.ArmKinematics):
    """The Jaco beside a person in the seated pose, with its palm towards the right arm."""

    def __init__(self, model: mujoco.MjModel) -> None:
        seated = dict(zip(human.ARM_JOINTS, human.start_angles(), strict=True))
        super().__init__(model, rotation=GOAL_ROTATION, person=seated)


def solve_starts(parameters: ItchScratchingParameters, count: int, seed: int) -> np.ndarray:
    """Joint angles [rad] of `count` clear starts, shape (count, 7), on one branch."""
    spec = build_spec(parameters)
    for geom in spec.geoms:
        geom.margin = kinematics.CLEARANCE
    arm, rng = ArmKinematics(spec.compile()), np.random.default_rng(seed)
    return kinematics.solve_near(arm, GOAL, GOAL_SPREAD, count, rng)


@cache
def stored_starts() -> Float[np.ndarray, "256 7"]:
    """The starts that ship with the package, joint angles [rad]."""
    source = resources.files("rigid.tasks.itch_scratching") / "starts.npz"
    with resources.as_file(source) as path, np.load(path) as file:
        return np.asarray(file["angles"], dtype=np.float64)


def clear_starts(model: mujoco.MjModel) -> Float[np.ndarray, "n 7"]:
    """The stored starts that touch nothing in `model` (larger bodies rule some out)."""
    return kinematics.clear_poses(ArmKinematics(model), stored_starts())


if __name__ == "__main__":
    angles = solve_starts(ItchScratchingParameters(), COUNT, _SEED)
    np.savez_compressed(Path(__file__).with_name("starts.npz"), angles=angles.astype(np.float32))
