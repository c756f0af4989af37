"""The compiled task, and one run of the scripted robot, shared by every test of feeding."""

import numpy as np
import pytest

from rigid.tasks.feeding.task import Feeding
from tests.tasks.feeding.feeder import Feeder

SEEDS = np.arange(6)


def play(task, human, seeds=SEEDS, steps=None):
    """The world after an episode of the scripted robot, its steps and its snapshots.

    Args:
        task: Feeding.
        human: Actions (B, 4) of a step's number.
        seeds: Of the worlds.
        steps: By default a whole episode.
    """
    world, robot = task.make_world(len(seeds), threads=1), Feeder(task)
    rows, snapshots = [world.reset(seeds)], [world.snapshot()]
    for number in range(steps or task.horizon):
        action, _ = robot.act(rows[-1].robot_observation, (), None)
        rows.append(world.step(action, human(number)))
        snapshots.append(world.snapshot())
    return world, rows, np.array(snapshots)


@pytest.fixture(scope="session")
def task():
    """The reference person."""
    return Feeding()


@pytest.fixture(scope="session")
def fed(task):
    """The scripted robot feeds six people who keep still."""
    return play(task, lambda _: np.zeros((len(SEEDS), 4)))
