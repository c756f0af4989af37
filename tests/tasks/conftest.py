"""Compiled tasks, shared by every test that does not change them."""

import pytest

from rigid.tasks.bed_bathing.task import BedBathing
from rigid.tasks.feeding.task import Feeding
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.tasks.playing import start_by_name


@pytest.fixture(scope="session")
def itch_scratching():
    """The reference person, itch hidden from the robot."""
    return ItchScratching()


@pytest.fixture(scope="session")
def feeding():
    """The reference person."""
    return Feeding()


@pytest.fixture(scope="session")
def bed_bathing():
    """The reference person."""
    return BedBathing()


@pytest.fixture(scope="session")
def task(itch_scratching):
    """The task of tests that need one of RIGID's; folders of other tasks have their own."""
    return itch_scratching


@pytest.fixture(scope="module")
def start(task):
    """The scene at the start of an episode, and what robot and human see of it by name."""
    return start_by_name(task, 5)
