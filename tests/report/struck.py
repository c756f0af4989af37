"""A real episode in which the robot strikes the person's chest, and a run directory of such."""

import json

import mujoco
import numpy as np

from rigid.compute.run.checkpoint import save_arrays
from rigid.report.motion import Shown, read_motion
from rigid.tasks.bodies import jaco, scratcher
from tests.tasks.scripted import posed

ARRIVES = 3
FRAMES = ARRIVES + 3
PRESS = 0.01  # [m] that the tip ends up below the skin.


def snapshots_of_a_strike(task, strike=True):
    """As `World.snapshot` gives them; the arm goes to the chest and stays there, or where it is."""
    data = posed(task)
    start = data.qpos.copy()
    end = _tip_to(task.model, data, _front_of_chest(task.model, data)) if strike else start
    rows = []
    for frame in range(FRAMES):
        angles = start + min(frame / ARRIVES, 1) * (end - start)
        rows.append(np.concatenate([angles, 0 * angles, angles, [0, 0]]))
    return np.array(rows, np.float32)


def struck(task):
    """The episode, and beside it one in which nobody moves."""
    scene = task.scene()
    motions = [
        read_motion(scene, task.replay(snapshots_of_a_strike(task, strike)))
        for strike in (True, False)
    ]
    return scene, Shown("struck", *motions)


def _front_of_chest(model, data):
    """Just below the skin, where the chest is nearest to the tip."""
    geom = model.geom("chest").id
    centre, axis = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)[:, 2]
    tip = data.site(scratcher.TIP_SITE).xpos
    along = np.clip((tip - centre) @ axis, -model.geom_size[geom, 1], model.geom_size[geom, 1])
    near = centre + along * axis
    outward = (tip - near) / np.linalg.norm(tip - near)
    return near + (model.geom_size[geom, 0] - PRESS) * outward


def _tip_to(model, data, goal):
    """Angles that bring the tip to `goal`, by damped least squares."""
    joints = [int(model.joint(name).qposadr[0]) for name in jaco.JOINT_NAMES]
    jacobian, tip = np.zeros((3, model.nv)), model.site(scratcher.TIP_SITE).id
    for _ in range(200):
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, jacobian, None, tip)
        columns = jacobian[:, joints]
        square = columns @ columns.T + 1e-3 * np.eye(3)
        gap = goal - data.site_xpos[tip]
        data.qpos[joints] += columns.T @ np.linalg.solve(square, np.clip(gap, -0.05, 0.05))
    return data.qpos.copy()


POINTS = {  # Naturalness, adversarialness, faults: one natural, two doubtful, one that ran away.
    "s0-r1-l0": (0.85, 0.3, 0),
    "s0-r1-l1": (0.5, 0.6, 0),
    "s0-r1-l2": (0.6, 0.7, 0),
    "s0-r1-l3": (0.9, 1.0, 50),
}


def run_of_strikes(directory, task, payload, **settings):
    """A finished run directory: the robot strikes in every worst episode, in no other."""
    frontier = {**payload["frontier"], "points": []}
    template = payload["frontier"]["points"][0]
    for name, (x, y, faults) in POINTS.items():
        changes = {"naturalness": x, "adversarialness": y, "faults": faults, "lambda": 0.25}
        frontier["points"].append({**template, "id": name, **changes})
        _store_episodes(directory / "adversaries" / name / "episodes.npz", task)
    text = json.dumps(frontier, default=lambda value: value.tolist())
    (directory / "frontier.json").write_text(text, encoding="utf-8")
    identity = {"task": task.describe(), **settings}
    about = {
        "schema": 1, "identity": identity, "seeds": [0], "provenance": {"versions": {}},
    }  # fmt: skip
    (directory / "settings.json").write_text(json.dumps(about), encoding="utf-8")
    return directory


def _store_episodes(path, task):
    strike, quiet = (snapshots_of_a_strike(task, strike) for strike in (True, False))
    arrays = {
        "seeds": np.arange(3) + 40, "shown": np.array([2, 0]), "returns": np.array([9.0, 8, -7]),
        "outcome": np.array([0, 0, 2]), "snapshots": np.stack([strike, quiet]),
        "canonical_snapshots": np.stack([quiet, quiet]),
        "canonical_returns": np.array([400.0, 400]), "canonical_outcome": np.array([0, 0]),
    }  # fmt: skip
    save_arrays(path, arrays)
