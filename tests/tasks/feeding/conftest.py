"""The compiled task, and one run of the scripted robot, shared by every test of feeding."""

import numpy as np
import pytest

from tests.tasks.feeding.feeder import Feeder
from tests.tasks.playing import played

SEEDS = np.arange(6)


@pytest.fixture(scope="session")
def task(feeding):
    """The reference person."""
    return feeding


@pytest.fixture(scope="session")
def fed(task):
    """The scripted robot feeds six people who keep still."""
    return played(task, Feeder(task), lambda _: np.zeros((len(SEEDS), 4)), SEEDS)
