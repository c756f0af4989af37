"""The compiled task, and one run of the scripted robot, shared by every test of bed bathing."""

import numpy as np
import pytest

from tests.tasks.bed_bathing.bather import Bather
from tests.tasks.playing import played

SEEDS = np.arange(6)


def still(_):
    """A person who does nothing."""
    return np.zeros((len(SEEDS), 10))


@pytest.fixture(scope="session")
def task(bed_bathing):
    """The reference person."""
    return bed_bathing


@pytest.fixture(scope="session")
def bathed(task):
    """The scripted robot wipes the arms of six people who keep still."""
    return played(task, Bather(task), still, SEEDS)
