"""Open loop: recorded targets again at every step size, over windows too short for chaos."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any, NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float
from mujoco.batch import Batch

from benchmarks.physics.plan import DEFAULT, SETTINGS, WINDOW_REFERENCE, Plan, Setting
from benchmarks.physics.playing import play_block, task_at
from rigid.compute.subject import CANONICAL_FILE
from rigid.data.episodes import load_episodes
from rigid.naturalness.standardise import canonical_scale
from rigid.policies.loading import BUNDLED
from rigid.tasks.bodies import human
from rigid.tasks.itch_scratching.sensing import Sensors
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.physics.sensing import penetration_reader

_RECORDING = 1_000_000
"""Block of the recorded episodes: none of the closed loop's. Ours."""
_SETTLING = 1
"""Control steps before forces count: contacts begin as the task's step left them, and forget it in
some time constants of 0.04 s. Ours."""
_LIMIT_OR_CONTACT = tuple(
    int(kind)
    for kind in (
        mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT,
        mujoco.mjtConstraint.mjCNSTR_CONTACT_PYRAMIDAL,
    )
)


class Replayed(NamedTuple):
    """W windows of one step size."""

    impulse: Float[np.ndarray, " W"]
    """Robot on person [N s]."""
    peak_force: Float[np.ndarray, " W"]
    """Robot on person [N]."""
    penetration: Float[np.ndarray, " W"]
    """Deepest overlap [m]."""
    arm: Float[np.ndarray, "W 20"]
    """Joint angles [rad] and velocities [rad/s] of the person's arm at the end."""


def replay_windows(
    setting: Setting, snapshots: Float[np.ndarray, "W L1 state"], *, task: ItchScratching
) -> Replayed:
    """Starts at each window's first state and holds the targets of its L control steps.

    Forces and overlaps are those from the second control step on.

    Args:
        setting: The physics step.
        snapshots: `World.snapshot` at the beginning and after each control step.
        task: Itch scratching at that step.
    """
    model, sensors = task.model, Sensors(task.model)
    penetration = penetration_reader(model)
    size, itch = model.nq, snapshots[:, 0, -2].astype(int)
    batch = Batch(model, len(snapshots), 1)
    batch.bind("qpos")[:] = snapshots[:, 0, :size]
    batch.bind("qvel")[:] = snapshots[:, 0, size : 2 * size]
    impulse, peak, depth = (np.zeros(len(snapshots)) for _ in range(3))
    for number, after in enumerate(snapshots.transpose(1, 0, 2)[1:]):
        batch.bind("ctrl")[:] = after[:, 2 * size : 3 * size]
        record = batch.rollout(setting.substeps, record=("sensordata",))["sensordata"]
        if number < _SETTLING:
            continue
        force = sensors.contacts(record, itch).force_on_person
        impulse += force.sum(axis=1) * setting.step
        peak = np.maximum(peak, force.max(axis=1))
        depth = np.maximum(depth, penetration(record))
    joints = [int(model.joint(name).qposadr[0]) for name in human.ARM_JOINTS]
    ends = [np.array(batch.bind(name)[:, joints]) for name in ("qpos", "qvel")]
    return Replayed(impulse, peak, depth, np.concatenate(ends, axis=1))


def replay_pair(pair: str, plan: Plan) -> dict[str, Any]:
    """Records a pair at the task's step and replays its windows at every step.

    Returns:
        For each step (`settings`), lists with a value for each episode, see `by_episode`; the
        stiffness that contacts had (`softness`); and the share of windows with touch (`touched`).
    """
    played = play_block(pair, DEFAULT, count=plan.recorded, seed=plan.seed, block=_RECORDING)
    windows = cut(played.snapshots, plan.window)
    states = windows[:, 0]
    replays, softness = {}, {}
    for setting in (*SETTINGS, WINDOW_REFERENCE):
        task = task_at(setting)
        replays[setting.name] = replay_windows(setting, windows, task=task)
        softness[setting.name] = softness_of(task.model, states)
    touched = np.any([one.impulse > 0 for one in replays.values()], axis=0)
    reference = replays[WINDOW_REFERENCE.name]
    return {
        "settings": {
            name: by_episode(one, reference, touched, plan.recorded)
            for name, one in replays.items()
        },
        "softness": softness,
        "touched": float(touched.mean()),
    }


def cut(snapshots: Float[np.ndarray, "T1 N state"], length: int) -> Float[np.ndarray, "W L1 state"]:
    """Windows of `length` steps side by side in time; those of one episode follow each other."""
    begins = range(0, len(snapshots) - length, length)
    windows = np.stack([snapshots[begin : begin + length + 1] for begin in begins])
    ordered: Float[np.ndarray, "W L1 state"] = windows.transpose(2, 0, 1, 3)
    return ordered.reshape(-1, length + 1, snapshots.shape[-1])


def by_episode(
    mine: Replayed, reference: Replayed, touched: Bool[np.ndarray, " W"], episodes: int
) -> dict[str, list[float]]:
    """Numbers of each episode, whose windows are no independent draws.

    Forces and overlaps are sums over its windows with touch; `angles` is the mean distance of
    the arm's joint angles to the reference [canonical deviations], `angles_rad` the same in
    radians, `features` the root mean square distance of all that naturalness sees, whitened.
    """

    def summed(values: np.ndarray) -> list[float]:
        return [float(total) for total in (values * touched).reshape(episodes, -1).sum(axis=1)]

    def mean(values: np.ndarray) -> list[float]:
        return [float(one) for one in values.reshape(episodes, -1).mean(axis=1)]

    apart = mine.arm - reference.arm
    deviations, whitening = canonical_ruler()
    angles = np.abs(apart[:, : len(human.ARM_JOINTS)])
    return {
        "touched": summed(np.ones(len(touched))),
        "impulse": summed(mine.impulse),
        "impulse_error": summed(np.abs(mine.impulse - reference.impulse)),
        "peak_force": summed(mine.peak_force),
        "penetration": summed(mine.penetration),
        "angles": mean((angles / deviations).mean(axis=1)),
        "angles_rad": mean(angles.mean(axis=1)),
        "features": mean(np.sqrt(((apart @ whitening) ** 2).mean(axis=1))),
    }


@cache
def canonical_ruler() -> tuple[Float[np.ndarray, "10"], Float[np.ndarray, "20 20"]]:
    """Deviation of each joint angle [rad] on the bundled canonical data, and what whitens them.

    The whitening is that of every discriminator, without the itch, which no step changes.
    """
    with resources.as_file(BUNDLED / ItchScratching.name / "vanilla" / CANONICAL_FILE) as path:
        features = load_episodes(path, task=None).features
    moving = 2 * len(human.ARM_JOINTS)
    angles = features[..., : len(human.ARM_JOINTS)].reshape(-1, len(human.ARM_JOINTS))
    return angles.std(axis=0), canonical_scale(features).transform[:moving, :moving]


def softness_of(
    model: mujoco.MjModel, states: Float[np.ndarray, "W state"]
) -> Mapping[str, float | list[float]]:
    """Stiffness [1/s²] and damping [1/s] of every contact and joint limit at recorded states.

    MuJoCo ties a constraint to the reference acceleration -b v - k r (its manual, 'Computation');
    k and b are read from it as it uses them, after it has raised too short time constants.

    Returns:
        `constraints`, how many there were, and the least and largest `stiffness` and `damping`.
    """
    data, rows = mujoco.MjData(model), []
    for state in states:
        data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq : 2 * model.nq]
        mujoco.mj_forward(model, data)
        kept = np.isin(data.efc_type, _LIMIT_OR_CONTACT)
        rows.append(data.efc_KBIP.reshape(-1, 4)[kept, :2].copy())
    found = np.concatenate(rows)
    ends = [[float(column.min()), float(column.max())] for column in found.T] if len(found) else []
    stiffness, damping = ends or ([], [])
    return {"constraints": len(found), "stiffness": stiffness, "damping": damping}
