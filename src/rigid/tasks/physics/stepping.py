"""B copies of one scene on MuJoCo's native batch, with worlds whose physics ran away restarted."""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Bool, Float
from mujoco.batch import Batch

from rigid.tasks.physics.sensing import penetration_reader

TARGET_AHEAD = 0.25
"""A full action puts the target this far ahead of the measured angle [rad] (Assistive Gym)."""
MAX_SPEED = 50.0
"""A joint faster than this has run away [rad/s] (ours)."""
MAX_PENETRATION = 0.02
"""Bodies deeper in each other than this have run away [m] (ours)."""


class SteppedScene:
    """The batch's state, and what its sensors saw at every physics step of a control step."""

    def __init__(
        self,
        model: mujoco.MjModel,
        size: int,
        *,
        threads: int,
        substeps: int,
    ) -> None:
        """Builds the batch.

        Args:
            model: The scene; every joint is a driven hinge, and sensors see overlaps.
            size: Number of worlds, B.
            threads: Of the batch; 0: every core.
            substeps: Physics steps of a control step, S.
        """
        if mujoco.get_mju_user_warning() is None:
            # Faults are counted here; MuJoCo would log each to a file in the working directory.
            mujoco.set_mju_user_warning(lambda _: None)
        self.batch = Batch(model, size, threads)
        # Bound before the first call: a field that is bound later reads 0 until the next one.
        self.sensordata = self.batch.bind("sensordata")
        self.records = {"sensordata": np.zeros((size, substeps, model.nsensordata))}
        self.start = np.zeros((size, model.nq))
        self.faulted = np.zeros(size, dtype=bool)
        self._motion: Float[np.ndarray, "B S nq"] | None = None
        self._size, self._substeps = size, substeps
        self.penetration = penetration_reader(model)
        """Deepest overlap [m] of robot or person with anything, from the sensors of a step."""
        self._limits = model.jnt_range.copy()

    def begin(self, start: Float[np.ndarray, "B nq"]) -> Float[np.ndarray, "B n"]:
        """Puts every world at its start, at rest; returns the sensors there."""
        self.start, self.faulted = start, np.zeros(self._size, dtype=bool)
        self._put_at_start(np.arange(self._size, dtype=np.int32))
        if self._motion is not None:
            self._motion = self._angles_now()
        return np.asarray(self.sensordata.copy())

    def _put_at_start(self, worlds: np.ndarray) -> None:
        self.batch.reset(worlds, stage=mujoco.mjtStage.mjSTAGE_NONE.value)
        self.batch.bind("qpos")[worlds] = self.start[worlds]
        self.batch.bind("ctrl")[worlds] = self.start[worlds]
        self.batch.forward(worlds)  # Sensors are zero until a forward pass.

    def step(self, target: Float[np.ndarray, "B nq"]) -> Float[np.ndarray, "B S n"]:
        """Drives every joint towards `target` [rad], within its limits, for one control step.

        Returns:
            `sensordata` after each physics step. MuJoCo's sensors describe the state before the
            step, so entry s holds the forces that acted during physics step s. Of a world that
            has just run away: S times its start.
        """
        self.batch.bind("ctrl")[:] = np.clip(target, *self._limits.T)
        self.batch.rollout(self._substeps, record=tuple(self.records), out=self.records)
        data = self.records["sensordata"]
        broken = self._broken(data)
        if broken.any():
            worlds = np.flatnonzero(broken).astype(np.int32)
            self._put_at_start(worlds)
            data[worlds] = self.sensordata[worlds][:, None]
            self.faulted[worlds] = True
        if self._motion is not None:
            self._motion = self.records["qpos"]
            self._motion[broken] = self.start[broken][:, None]
        return data

    def keep_motion(self) -> None:
        """See `rigid.tasks.protocol.KeepsMotion`."""
        if self._motion is None:
            self.records["qpos"] = np.zeros((self._size, self._substeps, self.start.shape[1]))
            self._motion = self._angles_now()

    def motion(self) -> Float[np.ndarray, "B S nq"]:
        """See `rigid.tasks.protocol.KeepsMotion`."""
        if self._motion is None:
            raise ValueError("this world keeps no motion: call keep_motion() first")
        return self._motion.copy()

    def _angles_now(self) -> Float[np.ndarray, "B 1 nq"]:
        return np.array(self.batch.bind("qpos"))[:, None]

    def _broken(self, data: Float[np.ndarray, "B S n"]) -> Bool[np.ndarray, " B"]:
        """Worlds whose physics ran away."""
        speed, angle = self.batch.bind("qvel"), self.batch.bind("qpos")
        broken = ~(np.abs(speed) < MAX_SPEED).all(axis=1) | ~np.isfinite(angle).all(axis=1)
        broken |= ~np.isfinite(data).all(axis=(1, 2)) | (self.batch.status != 0)
        # A warning (bad control, full buffers) ends the world's control step early.
        broken |= self.batch.warning[..., 1].any(axis=1)
        broken |= self.penetration(data) > MAX_PENETRATION
        return np.asarray(broken)
