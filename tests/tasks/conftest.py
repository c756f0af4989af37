"""Compiled tasks, shared by every test that does not change them."""

import pytest

from rigid.tasks.itch_scratching.task import ItchScratching


@pytest.fixture(scope="session")
def task():
    """The reference person, itch hidden from the robot."""
    return ItchScratching()
