"""Writes a CSV file as a motion-capture laboratory might: degrees, milliseconds, names of its own.

Its people are RIGID's synthetic human with the bundled robot, sampled between control steps as a
camera would. `docs/canonical-data.md` goes from this file to a frontier.

Run: python examples/motion_capture.py motion.csv --episodes 16 --hz 25
"""

from __future__ import annotations

import argparse
import csv
from itertools import pairwise
from pathlib import Path

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.compute.search.scoring import play_with
from rigid.learning.rollout import policy_actor
from rigid.policies.loading import load_policy
from rigid.tasks.bodies.human import ARM_JOINTS
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.itch_scratching.task import ItchScratching

MAP = {
    "episode": "trial",
    "participant": "subject",
    "device": "system",
    "time": {"from": "t_ms", "unit": "ms"},
    **{joint: {"from": f"{joint}_deg", "unit": "deg"} for joint in ARM_JOINTS},
    **{f"itch_{limb}": {"from": "target", "equals": limb} for limb in LIMBS},
}
"""What each column is, for `rigid data import --map`."""


def sampled_angles(
    task: ItchScratching, states: Float[np.ndarray, "T1 state"], hz: float
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n 10"]]:
    """Times [s] and arm angles [rad] between the control steps of an episode.

    Every control step is stepped again from its own state, so that nothing drifts.
    """
    model, parameters = task.model, task.parameters
    data = mujoco.MjData(model)
    arm = [model.joint(name).qposadr[0] for name in ARM_JOINTS]
    nq, nv = model.nq, model.nv
    angles = [states[0, arm]]
    for state, after in pairwise(states):
        data.qpos[:], data.qvel[:] = state[:nq], state[nq : nq + nv]
        data.ctrl[:] = after[nq + nv : nq + nv + model.nu]
        for _ in range(parameters.substeps):
            mujoco.mj_step(model, data)
            angles.append(data.qpos[arm].copy())
    every = round(1 / (hz * parameters.physics_step))
    times = np.arange(len(angles)) * parameters.physics_step
    return times[::every], np.array(angles)[::every]


def record_people(path: Path, *, episodes: int, hz: float, seed: int = 0, people: int = 4) -> None:
    """Plays episodes and writes the arm's angles, the target and who moved."""
    task = ItchScratching()
    robot = load_policy("builtin:vanilla", task=task, agent="robot")
    human = load_policy("builtin:synthetic-human", task=task, agent="human")
    rng = np.random.default_rng(seed)
    starts = rng.integers(2**31, size=episodes)
    snapshots: list[np.ndarray] = []
    played = play_with(task, robot, policy_actor(human, episodes, rng), starts, snapshots=snapshots)
    states = np.stack(snapshots).swapaxes(0, 1).astype(np.float64)
    names = [f"{joint}_deg" for joint in ARM_JOINTS]
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["trial", "subject", "system", "t_ms", *names, "target"])
        for episode in range(episodes):
            target = LIMBS[int(np.argmax(played.features[0, episode, -len(LIMBS) :]))]
            times, angles = sampled_angles(task, states[episode], hz)
            who = [f"trial{episode:02}", f"P{episode % people + 1:02}", "8 cameras"]
            for time, row in zip(times, np.rad2deg(angles), strict=True):
                cells = [f"{angle:.4f}" for angle in row]
                writer.writerow([*who, f"{1000 * time:.0f}", *cells, target])


def main() -> None:
    """Writes FILE and, beside it, the map to read it with."""
    import json

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--episodes", type=int, default=16)
    parser.add_argument("--hz", type=float, default=25.0)
    options = parser.parse_args()
    record_people(options.file, episodes=options.episodes, hz=options.hz)
    columns = options.file.with_suffix(".map.json")
    columns.write_text(json.dumps(MAP, indent=1))
    print(f"{options.file} and {columns}")


if __name__ == "__main__":
    main()
