"""Energy: bodies that nothing drives must not gain any."""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Float
from mujoco.batch import Batch

from benchmarks.physics.plan import SETTINGS, SPEEDS, Plan, Setting, Swing
from benchmarks.physics.playing import task_at
from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching.scene import build_spec
from rigid.tasks.itch_scratching.task import ItchScratching

_WITHOUT: dict[Swing, tuple[mujoco.mjtDisableBit, ...]] = {
    "free": (
        mujoco.mjtDisableBit.mjDSBL_ACTUATION,
        mujoco.mjtDisableBit.mjDSBL_CONTACT,
        mujoco.mjtDisableBit.mjDSBL_LIMIT,
    ),
    "contact": (mujoco.mjtDisableBit.mjDSBL_ACTUATION,),
    "braked": (),
}
DOUBLED = 1.0
"""Growth is cut off here: whoever has doubled its energy is on its way to infinity."""


def swing_model(task: ItchScratching, swing: Swing) -> mujoco.MjModel:
    """The scene of `task` with what the swing does without switched off."""
    spec = build_spec(task.parameters)
    for bit in _WITHOUT[swing]:
        spec.option.disableflags |= bit
    spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    return spec.compile()


def swings(swing: Swing, plan: Plan) -> dict[str, dict[str, list[float]]]:
    """The gains of energy of one kind of swing, by speed and step."""
    return {
        f"{speed:g}": {one.name: swing_growth(swing, one, speed, plan) for one in SETTINGS}
        for speed in SPEEDS
    }


def swing_growth(swing: Swing, setting: Setting, speed: float, plan: Plan) -> list[float]:
    """By how much the energy of each swing rises above its start at most, as a share of it.

    Swings begin at the starts of episodes, where nothing touches, so that no energy is stored in
    contacts and all that comes out of one went into it before. The task has no gravity: potential
    energy is 0, and kinetic energy is all there is.

    Args:
        swing: What the bodies swing without.
        setting: The physics step.
        speed: Joint velocities are drawn within ± this [rad/s], alike for all steps.
        plan: Number and length of swings.
    """
    task = task_at(setting)
    model = swing_model(task, swing)
    angles, speeds = first_states(task, speed, plan)
    _silence()
    batch = Batch(model, plan.swings, 1)
    batch.bind("qpos")[:], batch.bind("qvel")[:] = angles, speeds
    first, highest = None, np.zeros(plan.swings)
    for _ in range(plan.swing_steps):
        batch.bind("ctrl")[:] = np.nan_to_num(batch.bind("qpos"))  # Action 0: targets are angles.
        with np.errstate(all="ignore"):  # Who has run away has no finite energy.
            record = batch.rollout(setting.substeps, record=("energy",))["energy"]
            energy = record.sum(axis=-1)
            first = energy[:, 0].copy() if first is None else first
            highest = np.fmax(highest, _largest(energy / first[:, None] - 1.0))
    return [float(one) for one in highest]


def _largest(growth: Float[np.ndarray, "B S"]) -> Float[np.ndarray, " B"]:
    """The largest of each row; no number, or more than all, counts as `DOUBLED`."""
    bounded = np.minimum(np.where(np.isfinite(growth), growth, DOUBLED), DOUBLED)
    largest: Float[np.ndarray, " B"] = bounded.max(axis=1)
    return largest


def first_states(
    task: ItchScratching, speed: float, plan: Plan
) -> tuple[Float[np.ndarray, "B q"], Float[np.ndarray, "B q"]]:
    """Angles [rad] and velocities [rad/s] at the beginning of each swing."""
    rng, model = np.random.default_rng([plan.seed, 2]), task.model
    angles = np.zeros((plan.swings, model.nq))
    arm, robot = (
        [int(model.joint(name).qposadr[0]) for name in names]
        for names in (human.ARM_JOINTS, jaco.JOINT_NAMES)
    )
    angles[:, arm] = human.start_angles()
    angles[:, robot] = task.starts[rng.integers(len(task.starts), size=plan.swings)]
    return angles, rng.uniform(np.full(angles.shape, -speed), speed)


def _silence() -> None:
    """Keeps MuJoCo from writing a log for each world that runs away: here it is a finding."""
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(lambda _: None)
