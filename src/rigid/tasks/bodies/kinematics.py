"""Where a Jaco holds its hand: forward and inverse kinematics, for poses where episodes begin."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from rigid.errors import UserError
from rigid.tasks.bodies import jaco

ROOM = 0.15
"""A start is dropped when a joint is closer to its limit [rad]. Ours."""
CLEARANCE = 0.01
"""A start is dropped when anything of the robot is closer to something [m]. Ours."""


class ArmKinematics:
    """Kinematics of the Jaco in one scene, with the hand turned as a task wants it."""

    def __init__(
        self, model: mujoco.MjModel, *, rotation: Rotation, person: Mapping[str, float]
    ) -> None:
        """Builds the kinematics.

        Args:
            model: The scene.
            rotation: Of the end effector in the world, which `solve` aims at.
            person: The person's joint angles [rad] by name.
        """
        self.model, self.data, self._goal = model, mujoco.MjData(model), rotation
        joints = [model.joint(name) for name in jaco.JOINT_NAMES]
        self.address = np.array([joint.qposadr[0] for joint in joints])
        self.limits = np.array([joint.range for joint in joints])
        for name, angle in person.items():
            self.data.joint(name).qpos = angle

    def pose(self, angles: Float[np.ndarray, "7"]) -> tuple[np.ndarray, Rotation]:
        """Position [m] and rotation of the end effector at the joint `angles` [rad]."""
        self.data.qpos[self.address] = angles
        mujoco.mj_kinematics(self.model, self.data)
        site = self.data.site(jaco.END_EFFECTOR_SITE)
        return site.xpos.copy(), Rotation.from_matrix(site.xmat.reshape(3, 3))

    def clear(self, angles: Float[np.ndarray, "7"]) -> bool:
        """Whether the robot touches nothing at `angles`."""
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
            turn = (self._goal.inv() * rotation).as_rotvec()
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


def find_branch(
    arm: ArmKinematics,
    goal: Float[np.ndarray, "3"],
    rng: np.random.Generator,
    tries: int = 200,
) -> Float[np.ndarray, "7"]:
    """Clear joint angles for `goal` [m] with the most dexterity and room to every joint limit.

    Raises:
        UserError: There are none.
    """
    best, best_room = None, -np.inf
    for _ in range(tries):
        guess = rng.uniform(np.maximum(arm.limits[:, 0], -np.pi), np.minimum(arm.limits[:, 1], 5.5))
        angles = arm.solve(goal, guess)
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


def solve_near(
    arm: ArmKinematics,
    goal: Float[np.ndarray, "3"],
    spread: float,
    count: int,
    rng: np.random.Generator,
) -> Float[np.ndarray, "n 7"]:
    """Joint angles [rad] of `count` clear poses on one branch of the arm.

    Args:
        arm: In a scene whose geoms have `CLEARANCE` as margin.
        goal: Middle of where the end effector is to be [m].
        spread: Half width of the box around it [m].
        count: How many.
        rng: Draws places in the box.
    """
    branch = find_branch(arm, goal, rng)
    found: list[np.ndarray] = []
    while len(found) < count:
        angles = arm.solve(goal + rng.uniform(-spread, spread, 3), branch)
        if angles is None or not arm.clear(angles) or arm.room(angles) < ROOM:
            continue
        if np.abs(angles - branch).max() < 1.0:
            found.append(angles)
    return np.array(found)


def clear_poses(
    arm: ArmKinematics, stored: Float[np.ndarray, "n 7"], least: int = 16
) -> Float[np.ndarray, "m 7"]:
    """Those of the stored poses that touch nothing (larger bodies rule some out).

    Raises:
        UserError: Fewer than `least` do.
    """
    clear = np.array([angles for angles in stored if arm.clear(angles)])
    if len(clear) < least:
        raise UserError(
            f"only {len(clear)} of {len(stored)} start poses are free of collisions in this scene; "
            "choose a body percentile nearer 50"
        )
    return clear
