"""From where a point of the body shall be to the action that brings it there.

Damped least squares (Wampler, 1986; Nakamura and Hanafusa, 1986; survey: Buss, 2009): of all
changes of the joints, the one that minimises |J dq - e|² + damping² |dq|². The damping keeps it
small, and smooth in everything it depends on, where the arm is stretched out and J loses rank.
Bounds are met one after the other: a joint that would leave its range stops there, and the others
are solved again (Baerlocher and Boulic, 2004, without their priorities).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.physics.stepping import TARGET_AHEAD

DAMPING = 0.1
"""[m/rad], ours: a joint that moves the point by less than this a radian hardly takes part. At half
of it an outstretched arm begins to chatter."""
CLOSED = 0.8
"""Share of the way that a light joint goes in one control step. Ours: 1.2 makes the arm swing."""
LOOK_AHEAD = 0.13
"""How far ahead the joints are taken to be where they are going [s]. Ours: heavy joints need about
as long to change their speed, and so brake in time. At 0.1 the hand overshoots a leap of 12 cm by
1.7 cm instead of 1.2 cm; at 0.15 it is half a centimetre farther behind on a slow circle."""
CLEAR = 0.03
"""As `DAMPING`, of what decides which changes the point minds [m/rad]. Ours: at 0.1, the pull
towards the natural pose keeps an outstretched hand almost a centimetre from its target."""
LEASH = 0.1
"""The target is followed as if it were at most this far away [m]. Ours: farther ones ask for full
speed anyhow, and one step of the linear model is good for no more (Buss, 2009, clamps alike)."""
POSTURE = 0.3
"""Share of the way to the natural pose that joints go in a step, where the point does not mind.
Ours: where the synthetic human's hand leads the arm, the bundled robot of itch scratching then
succeeds always; at 0.03 towards the seated pose instead, in a third of the episodes."""

Natural = Callable[[Float[np.ndarray, "3"]], Float[np.ndarray, " n"]]
"""The pose [rad] of all joints that goes with a place of the point [m]."""


class PulledChain:
    """Joints that carry one point, and how they follow it."""

    def __init__(
        self,
        model: mujoco.MjModel,
        joints: Sequence[str],
        *,
        body: str,
        point: Float[np.ndarray, "3"],
        period: float,
    ) -> None:
        """Resolves the names.

        Args:
            model: The scene; each joint JOINT has a position servo JOINT_servo.
            joints: Those that move the point, in the order of the action.
            body: Which carries it.
            point: In that body's frame [m].
            period: Of a control step [s].
        """
        self._model, self._data = model, mujoco.MjData(model)
        self.address = np.array([model.joint(name).qposadr[0] for name in joints])
        self.dofs = np.array([model.joint(name).dofadr[0] for name in joints])
        self._limits = np.array([model.joint(name).range for name in joints])
        self.body, self.point = int(model.body(body).id), point
        servos = [model.actuator(f"{name}_servo").id for name in joints]
        # A servo of stiffness k and damping d closes k/d of its distance to the target a second.
        rate = model.actuator_gainprm[servos, 0] / -model.actuator_biasprm[servos, 2]
        self._gain = CLOSED / (1 - np.exp(-rate * period)) / TARGET_AHEAD
        self._jacobian = np.zeros((3, model.nv))

    def place(self, angles: Float[np.ndarray, " n"]) -> Float[np.ndarray, "3"]:
        """Where the point is at the joints' `angles` [rad], world frame [m]."""
        self._data.qpos[self.address] = angles
        mujoco.mj_kinematics(self._model, self._data)
        turned = self._data.xmat[self.body].reshape(3, 3) @ self.point
        return np.asarray(self._data.xpos[self.body] + turned)

    def towards(
        self,
        angles: Float[np.ndarray, " n"],
        speeds: Float[np.ndarray, " n"],
        target: Float[np.ndarray, "3"],
        natural: Natural,
    ) -> Float[np.ndarray, " n"]:
        """The action in [-1, 1] that moves the point towards `target`.

        An action that would exceed 1 is scaled as a whole, so that it keeps its direction.

        Args:
            angles: Of the joints, as measured [rad].
            speeds: Of the joints [rad/s].
            target: World frame [m].
            natural: Pose to which the joints go where the point leaves them free.
        """
        start = self._expected(angles, speeds)
        place = self.place(start)
        away = target - place
        away *= LEASH / max(float(np.linalg.norm(away)), LEASH)
        pull = POSTURE * (natural(place + away) - start)
        change = bounded_change(self._at(place), away, pull, (self._limits.T - start).T)
        action = change * self._gain
        return np.asarray(action / max(float(np.abs(action).max()), 1.0))

    def _expected(self, angles: np.ndarray, speeds: np.ndarray) -> Float[np.ndarray, " n"]:
        """Where the joints are going, within their ranges; MuJoCo's are soft."""
        low, high = self._limits.T
        return np.asarray(np.minimum(np.maximum(angles + LOOK_AHEAD * speeds, low), high))

    def _at(self, place: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 n"]:
        """Jacobian of the point, which is at `place`, in the pose that was set last."""
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jac(self._model, self._data, self._jacobian, None, place, self.body)
        return self._jacobian[:, self.dofs]


def bounded_change(
    jacobian: Float[np.ndarray, "3 n"],
    away: Float[np.ndarray, "3"],
    pull: Float[np.ndarray, " n"],
    bounds: Float[np.ndarray, "n 2"],
) -> Float[np.ndarray, " n"]:
    """Change of the joints [rad] that moves a point by about `away` [m], within bounds.

    It minimises |J dq - away|² + damping² |dq - free pull|² over the joints that may still move,
    where the free pull is that part of `pull` which hardly moves the point.

    Args:
        jacobian: Of the point, J [m/rad].
        away: [m]
        pull: Change that the joints would make if the point did not mind [rad].
        bounds: Least and largest change of each joint [rad]; 0 lies between them.

    Example:
        >>> jacobian, limits = np.zeros((3, 2)), np.array([[-1, 1], [-1, 0.1]])
        >>> jacobian[0] = 1.0
        >>> bounded_change(jacobian, np.array([0.5, 0, 0]), np.zeros(2), limits).round(2)
        array([0.4, 0.1])
    """
    free: Bool[np.ndarray, " n"] = np.ones(len(pull), dtype=bool)
    change = np.zeros(len(pull))
    while free.any():
        moving, wanted = jacobian[:, free], pull[free]
        wanted = wanted - _damped(moving, moving @ wanted, CLEAR)
        left = away - jacobian[:, ~free] @ change[~free] - moving @ wanted
        change[free] = wanted + _damped(moving, left, DAMPING)
        kept = np.minimum(np.maximum(change, bounds[:, 0]), bounds[:, 1])
        over = free & (kept != change)
        if not over.any():
            break
        change, free = np.where(over, kept, change), free & ~over
    return change


def _damped(
    jacobian: Float[np.ndarray, "3 n"], away: Float[np.ndarray, "3"], damping: float
) -> Float[np.ndarray, " n"]:
    """Jᵀ(JJᵀ + damping²)⁻¹ away."""
    normal = jacobian @ jacobian.T + damping**2 * np.eye(3)
    return np.asarray(jacobian.T @ np.linalg.solve(normal, away))
