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
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from rigid.errors import UserError
from rigid.tasks.bodies import human, jaco
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
_ROOM = 0.15  # [rad], ours: a start is dropped when a joint is closer to its limit.
_CLEARANCE = 0.01  # [m], ours: a start is dropped when anything of the robot is closer.


class ArmKinematics:
    """Forward kinematics of the Jaco in one scene, for solving poses."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        joints = [model.joint(name) for name in jaco.JOINT_NAMES]
        self.address = np.array([joint.qposadr[0] for joint in joints])
        self.limits = np.array([joint.range for joint in joints])
        arm = np.array([model.joint(name).qposadr[0] for name in human.ARM_JOINTS])
        self.data.qpos[arm] = human.start_angles()

    def pose(self, angles: Float[np.ndarray, "7"]) -> tuple[np.ndarray, Rotation]:
        """Position [m] and rotation of the end effector at the joint `angles` [rad]."""
        self.data.qpos[self.address] = angles
        mujoco.mj_kinematics(self.model, self.data)
        site = self.data.site(jaco.END_EFFECTOR_SITE)
        return site.xpos.copy(), Rotation.from_matrix(site.xmat.reshape(3, 3))

    def clear(self, angles: Float[np.ndarray, "7"]) -> bool:
        """Whether the robot touches nothing at `angles`, with the person in the seated pose."""
        self.data.qpos[self.address] = angles
        mujoco.mj_forward(self.model, self.data)
        robot = self.model.body(jaco.BASE_BODY).id
        for contact in self.data.contact:
            roots = self.model.body_rootid[self.model.geom_bodyid[list(contact.geom)]]
            if robot in roots:
                return False
        return True

    def solve(
        self, position: np.ndarray, guess: Float[np.ndarray, "7"]
    ) -> Float[np.ndarray, "7"] | None:
        """Joint angles near `guess` that bring the end effector to `position`, or None."""

        def residual(angles: np.ndarray) -> np.ndarray:
            where, rotation = self.pose(angles)
            turn = (GOAL_ROTATION.inv() * rotation).as_rotvec()
            # The last term keeps the redundant joint near the guess.
            return np.concatenate([where - position, 0.3 * turn, 1e-3 * (angles - guess)])

        low, high = self.limits.T
        fit = least_squares(residual, np.clip(guess, low + 1e-3, high - 1e-3), bounds=(low, high))
        miss = residual(fit.x)
        if np.linalg.norm(miss[:3]) > 0.01 or np.linalg.norm(miss[3:6]) > 0.003:
            return None
        return self._wrapped(fit.x)

    def room(self, angles: Float[np.ndarray, "7"]) -> float:
        """Least distance of a joint to its limit [rad]."""
        return float(np.minimum(angles - self.limits[:, 0], self.limits[:, 1] - angles).min())

    def _wrapped(self, angles: np.ndarray) -> np.ndarray:
        """The same pose with every joint that can turn right round in [-π, π)."""
        turns = self.limits[:, 1] >= 2 * np.pi - 1e-6
        return np.where(turns, (angles + np.pi) % (2 * np.pi) - np.pi, angles)


def find_branch(arm: ArmKinematics, rng: np.random.Generator, tries: int = 200) -> np.ndarray:
    """Clear joint angles for the middle goal with the most room to every joint limit."""
    best, best_room = None, -np.inf
    for _ in range(tries):
        guess = rng.uniform(np.maximum(arm.limits[:, 0], -np.pi), np.minimum(arm.limits[:, 1], 5.5))
        angles = arm.solve(GOAL, guess)
        if angles is None or not arm.clear(angles):
            continue
        room = dexterity(arm, angles)
        if room > best_room:
            best, best_room = angles, room
    if best is None:
        raise UserError("no collision-free pose of the robot reaches the start of this scene")
    return best


def dexterity(arm: ArmKinematics, angles: Float[np.ndarray, "7"]) -> float:
    """Yoshikawa's manipulability of the end effector, times the least room to a joint limit."""
    arm.pose(angles)
    mujoco.mj_comPos(arm.model, arm.data)
    jacobian = np.zeros((3, arm.model.nv))
    site = arm.model.site(jaco.END_EFFECTOR_SITE).id
    mujoco.mj_jacSite(arm.model, arm.data, jacobian, None, site)
    columns = jacobian[:, arm.address]
    return float(np.sqrt(np.linalg.det(columns @ columns.T)) * min(arm.room(angles), 1.0))


def solve_starts(parameters: ItchScratchingParameters, count: int, seed: int) -> np.ndarray:
    """Joint angles [rad] of `count` clear starts, shape (count, 7), on one branch."""
    spec = build_spec(parameters)
    for geom in spec.geoms:
        geom.margin = _CLEARANCE
    arm = ArmKinematics(spec.compile())
    rng = np.random.default_rng(seed)
    branch = find_branch(arm, rng)
    starts: list[np.ndarray] = []
    while len(starts) < count:
        goal = GOAL + rng.uniform(-GOAL_SPREAD, GOAL_SPREAD, 3)
        angles = arm.solve(goal, branch)
        if angles is None or not arm.clear(angles) or arm.room(angles) < _ROOM:
            continue
        if np.abs(angles - branch).max() < 1.0:
            starts.append(angles)
    return np.array(starts)


@cache
def stored_starts() -> Float[np.ndarray, "256 7"]:
    """The starts that ship with the package, joint angles [rad]."""
    source = resources.files("rigid.tasks.itch_scratching") / "starts.npz"
    with resources.as_file(source) as path, np.load(path) as file:
        return np.asarray(file["angles"], dtype=np.float64)


def clear_starts(model: mujoco.MjModel) -> Float[np.ndarray, "n 7"]:
    """The stored starts that touch nothing in `model` (larger bodies rule some out)."""
    arm = ArmKinematics(model)
    starts = np.array([angles for angles in stored_starts() if arm.clear(angles)])
    if len(starts) < 16:
        raise UserError(
            f"only {len(starts)} of {COUNT} start poses are free of collisions in this scene; "
            "choose a body percentile nearer 50"
        )
    return starts


if __name__ == "__main__":
    angles = solve_starts(ItchScratchingParameters(), COUNT, _SEED)
    np.savez_compressed(Path(__file__).with_name("starts.npz"), angles=angles.astype(np.float32))
