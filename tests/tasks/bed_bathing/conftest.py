"""The compiled task, and one run of the scripted robot, shared by every test of bed bathing."""

import numpy as np
import pytest

from rigid.tasks.bed_bathing.task import BedBathing
from tests.tasks.bed_bathing.bather import Bather

SEEDS = np.arange(6)


def play(task, human, seeds=SEEDS, steps=None):
    """The world after an episode of the scripted robot, its steps and its snapshots.

    Args:
        task: Bed bathing.
        human: Actions (B, 10) of a step's number.
        seeds: Of the worlds.
        steps: By default a whole episode.
    """
    world, robot = task.make_world(len(seeds), threads=1), Bather(task)
    rows, snapshots = [world.reset(seeds)], [world.snapshot()]
    state = robot.initial_state(len(seeds))
    for number in range(steps or task.horizon):
        action, state = robot.act(rows[-1].robot_observation, state, None)
        rows.append(world.step(action, human(number)))
        snapshots.append(world.snapshot())
    return world, rows, np.array(snapshots)


def still(_):
    """A person who does nothing."""
    return np.zeros((len(SEEDS), 10))


@pytest.fixture(scope="session")
def task():
    """The reference person."""
    return BedBathing()


@pytest.fixture(scope="session")
def bathed(task):
    """The scripted robot wipes the arms of six people who keep still."""
    return play(task, still)
