"""What a player holds of a MuJoCo person: a point of the body, and what is drawn of its motion."""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.by_hand import Reach
from rigid.tasks.physics.drawing import body_poses
from rigid.tasks.physics.reaching import Natural, PulledChain


class MovedPoint:
    """The shared part of `rigid.tasks.by_hand.Handle`: all but what the episode is about."""

    def __init__(
        self,
        model: mujoco.MjModel,
        chain: PulledChain,
        *,
        root: str,
        rest: Float[np.ndarray, " n"],
        natural: Natural,
        substeps: int,
    ) -> None:
        """Takes hold of the point.

        Args:
            model: The scene as it is drawn; its joints are those of the world.
            chain: Moves the point.
            root: Body whose frame is the middle of the reach.
            rest: Pose of the chain's joints in which that middle is taken [rad].
            natural: Their pose where the point leaves them free.
            substeps: Physics steps of a control step.
        """
        self.model, self._data = model, mujoco.MjData(model)
        self._chain, self._natural, self.substeps = chain, natural, substeps
        self.bodies = tuple(i for i in range(model.nbody) if model.body_weldid[i] != 0)
        self.reach = _reach(model, root, chain, rest)

    def place(self, state: Float[np.ndarray, " state"]) -> Float[np.ndarray, "3"]:
        """Where the point is [m], world frame."""
        return self._chain.place(self._joints(state)[0])

    def towards(
        self, state: Float[np.ndarray, " state"], target: Float[np.ndarray, "3"]
    ) -> Float[np.ndarray, " a"]:
        """The human's action in [-1, 1] that moves the point towards `target` [m]."""
        return self._chain.towards(*self._joints(state), target, self._natural)

    def poses(
        self, motion: Float[np.ndarray, "S nq"], state: Float[np.ndarray, " state"]
    ) -> Float[np.ndarray, "S bodies 7"]:
        """Position [m] and quaternion w, x, y, z of `bodies` after each physics step."""
        del state
        moving, found = list(self.bodies), []
        for angles in motion:
            self._data.qpos[:] = angles
            mujoco.mj_kinematics(self.model, self._data)
            found.append(body_poses(self._data)[moving])
        return np.array(found)

    def _joints(self, state: Float[np.ndarray, " state"]) -> tuple[np.ndarray, np.ndarray]:
        """Angles [rad] and speeds [rad/s] of the chain's joints."""
        wide = np.asarray(state, dtype=np.float64)
        speeds = wide[self.model.nq : self.model.nq + self.model.nv]
        return wide[self._chain.address], speeds[self._chain.dofs]


def _reach(model: mujoco.MjModel, root: str, chain: PulledChain, rest: np.ndarray) -> Reach:
    """The ball about the root, at rest, with the radius of all links from there stretched out."""
    first, link = int(model.body(root).id), chain.body
    radius = float(np.linalg.norm(chain.point))
    while link != first:
        radius += float(np.linalg.norm(model.body_pos[link]))
        link = int(model.body_parentid[link])
    data = mujoco.MjData(model)
    data.qpos[chain.address] = rest
    mujoco.mj_kinematics(model, data)
    return Reach(np.array(data.xpos[first]), radius)
