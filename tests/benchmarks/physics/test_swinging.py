"""Swings: what they begin with, and what they gain."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from benchmarks.physics.plan import DEFAULT, PLAN, SPEEDS, Setting
from benchmarks.physics.playing import task_at
from benchmarks.physics.swinging import DOUBLED, first_states, swing_growth, swing_model

SHORT = replace(PLAN, swings=4, swing_steps=10)


def test_swings_begin_alike_at_every_step_and_touch_nothing():
    (angles, speeds), (same, also) = (
        first_states(task_at(one), 1.0, SHORT) for one in (DEFAULT, Setting(0.01))
    )
    np.testing.assert_array_equal(angles, same)
    np.testing.assert_array_equal(speeds, also)
    model = task_at(DEFAULT).model
    data = mujoco.MjData(model)
    for row in angles:
        data.qpos[:] = row
        mujoco.mj_forward(model, data)
        assert data.nefc == 0


def test_speeds_are_the_same_draws_times_the_fastest():
    slow, fast = (first_states(task_at(DEFAULT), speed, SHORT)[1] for speed in SPEEDS)
    np.testing.assert_allclose(fast / slow, SPEEDS[1] / SPEEDS[0])
    assert np.abs(fast).max() <= SPEEDS[1]


def test_a_free_swing_gains_less_at_a_finer_step():
    coarse, fine = (swing_growth("free", one, 1.0, SHORT) for one in (DEFAULT, Setting(0.005)))
    assert np.mean(coarse) > 2 * np.mean(fine) > 0


def test_servos_take_energy():
    assert max(swing_growth("braked", DEFAULT, 1.0, SHORT)) == 0.0


def test_who_runs_away_has_doubled_its_energy_and_leaves_no_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert swing_growth("free", DEFAULT, 60.0, SHORT) == [DOUBLED] * SHORT.swings
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("swing", "forces"), [("free", 0), ("contact", 1)])
def test_bodies_in_each_other_push_only_where_there_are_contacts(swing, forces):
    model = swing_model(task_at(DEFAULT), swing)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)  # At zero angles the arm is in the chair, joints beyond limits.
    assert (data.nefc > 0) == forces
    assert not data.actuator_force.any()
