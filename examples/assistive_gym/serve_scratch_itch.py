"""Assistive Gym's ScratchItchJacoHuman-v1 as a task of RIGID, served from its own Python 3.7.

Written against version 1.0 of Assistive Gym; not run in this repository's tests, which cannot
install it. README.md beside this file says how to use it.
"""

from __future__ import annotations

import argparse
import functools
from typing import Any

import assistive_gym.envs.env
import numpy as np
import rigid_serve
from assistive_gym.envs import ScratchItchJacoHumanEnv

# Every environment loads the same network of arm limits; once is enough for all of a process.
assistive_gym.envs.env.load_model = functools.lru_cache(maxsize=None)(
    assistive_gym.envs.env.load_model
)

JOINTS = (
    "pecs_x", "pecs_y", "pecs_z", "shoulder_x", "shoulder_y", "shoulder_z", "elbow", "forearm",
    "wrist_x", "wrist_y",
)  # fmt: skip
"""Of the right arm, in Assistive Gym's order."""
FEATURES = (
    *(joint + "_angle" for joint in JOINTS),
    *(joint + "_velocity" for joint in JOINTS),
    "itch_on_upper_arm",
    "itch_on_forearm",
)
UNITS = {
    name: "rad" if name.endswith("angle") else "rad/s" for name in FEATURES if "itch" not in name
}


class ScratchItch:
    """One environment, as `rigid_serve.serve_task` wants it."""

    def __init__(self) -> None:
        self._env = ScratchItchJacoHumanEnv()

    def reset(self, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """The same seed gives the same person, itch and first pose."""
        self._env.set_seed(seed)  # `env.seed` would not reach the parts that hold the generator.
        seen = self._env.reset()
        return seen["robot"], seen["human"]

    def step(self, robot_action: np.ndarray, human_action: np.ndarray) -> tuple[Any, ...]:
        """One control step of 0.1 s."""
        actions = {"robot": robot_action, "human": human_action}
        seen, rewards, dones, infos = self._env.step(actions)
        info = {
            "success": infos["robot"]["task_success"],
            "force": infos["robot"]["total_force_on_human"],
            "features": self._features(),
        }
        return seen["robot"], seen["human"], rewards["robot"], dones["__all__"], info

    def _features(self) -> np.ndarray:
        """Joint angles and velocities of the arm, and where it itches: what RIGID calls natural."""
        human = self._env.human
        _, angles, velocities, _ = human.get_motor_joint_states(human.controllable_joint_indices)
        on_upper_arm = self._env.limb == human.right_shoulder
        return np.array([*angles, *velocities, on_upper_arm, not on_upper_arm])


def main() -> None:
    """Serves until RIGID is done."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--horizon", type=int, default=200, help="steps; the RIGID paper has 100")
    rigid_serve.serve_task(
        ScratchItch,
        horizon=parser.parse_args().horizon,
        robot=(30, 7),
        human=(34, 10),
        feature_names=FEATURES,
        feature_units=UNITS,
        control_period=0.1,
        timeout=600,  # Seconds: the first environment loads TensorFlow, and a reset solves for IK.
    )


if __name__ == "__main__":
    main()
