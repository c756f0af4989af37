"""Warnings of MuJoCo in environments of others."""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import pytest

from rigid.tasks.bridges.once import warn_once

FALLING = "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"


@pytest.fixture(autouse=True)
def no_handler() -> Iterator[None]:
    """MuJoCo as it is imported, whatever earlier tests told this process."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(None)
    yield
    mujoco.set_mju_user_warning(before)


def run_away(speed: float) -> None:
    """One step of a body that is too fast for MuJoCo [m/s]."""
    model = mujoco.MjModel.from_xml_string(FALLING)
    data = mujoco.MjData(model)
    data.qvel[:] = speed
    mujoco.mj_step(model, data)


def test_a_warning_of_many_environments_is_said_once_and_leaves_no_log_file(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)  # Where MuJoCo would write its log.
    warn_once()
    for speed in (1e20, 2e20, 3e20):
        run_away(speed)
    said = capsys.readouterr().err
    assert said.count("MuJoCo: ") == 1
    assert "Nan, Inf or huge value" in said
    assert list(tmp_path.iterdir()) == []


def test_a_handler_that_somebody_has_set_stays(capsys):
    heard: list[str] = []
    mujoco.set_mju_user_warning(heard.append)
    warn_once()
    run_away(1e20)
    assert len(heard) == 1
    assert capsys.readouterr().err == ""
