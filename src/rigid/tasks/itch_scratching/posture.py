"""How the bundled synthetic human holds its arm, by where it holds its hand.

`make bundled` watches it with the bundled robot again once both are trained anew, and rewrites
`posture.npz`; so does `python -m rigid.tasks.itch_scratching.posture` alone.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

import mujoco
import numpy as np

from rigid.tasks.bodies import human
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.physics.posture import Posture, fit_posture
from rigid.tasks.physics.reaching import PulledChain

_FILE = "posture.npz"
_EPISODES = 50  # Ours: 5000 moments for 90 numbers.


@cache
def stored_posture() -> Posture:
    """The posture that ships with the package; ways are those of the hand from the seated pose."""
    with resources.as_file(resources.files("rigid.tasks.itch_scratching") / _FILE) as path:
        return Posture.load(path)


def arm_of(model: mujoco.MjModel, parameters: ItchScratchingParameters) -> PulledChain:
    """The right arm, led by the middle of its hand."""
    return PulledChain(
        model,
        human.ARM_JOINTS,
        body="right_hand",
        point=np.array(model.geom("right_hand").pos),
        period=parameters.control_period,
    )


def watched_posture(episodes: int) -> Posture:
    """The posture of the bundled synthetic human in so many episodes with the bundled robot."""
    from rigid.learning.rollout import play, policy_actor
    from rigid.policies.loading import load_policy
    from rigid.tasks.itch_scratching.task import ItchScratching

    task = ItchScratching()
    robot = load_policy("builtin:vanilla", task=task)
    person = load_policy("builtin:synthetic-human", task=task, agent="human")
    played = play(
        task, task.make_world(episodes), np.arange(episodes),
        policy_actor(robot, episodes, None),
        policy_actor(person, episodes, np.random.default_rng(0)),
    )  # fmt: skip
    seated, arm = human.start_angles(), arm_of(task.model, task.parameters)
    angles = played.features.reshape(-1, played.features.shape[-1])[:, : len(seated)]
    ways = np.array([arm.place(row) for row in angles]) - arm.place(seated)
    return fit_posture(ways, angles.astype(np.float64), seated)


def rewrite() -> None:
    """Watches the bundled pair again and replaces the stored posture."""
    watched_posture(_EPISODES).save(Path(__file__).with_name(_FILE))


if __name__ == "__main__":
    rewrite()
