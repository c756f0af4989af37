"""Compiled tasks, shared by every test that does not change them."""

import pytest

from rigid.tasks.itch_scratching.task import ItchScratching


@pytest.fixture(scope="session")
def task():
    """The reference person, itch hidden from the robot."""
    return ItchScratching()


@pytest.fixture
def quiet_faults(tmp_path, monkeypatch):
    """MuJoCo writes MUJOCO_LOG.TXT into the working directory when a world runs away."""
    monkeypatch.chdir(tmp_path)
