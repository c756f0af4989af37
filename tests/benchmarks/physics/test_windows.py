"""Open loop: windows, their errors, and the stiffness that contacts really have."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from benchmarks.physics.plan import DEFAULT, SETTINGS, WINDOW_REFERENCE, Setting
from benchmarks.physics.playing import play_block, task_at
from benchmarks.physics.windows import (
    Replayed,
    by_episode,
    canonical_ruler,
    cut,
    replay_windows,
    softness_of,
)
from rigid.tasks.bodies import human

LENGTH = 5


@pytest.fixture(scope="module")
def windows():
    played = play_block("canonical", DEFAULT, count=2, seed=0, block=0)
    return cut(played.snapshots, LENGTH)


def replayed(impulse, arm):
    zeros = np.zeros(len(impulse))
    return Replayed(np.array(impulse), zeros, zeros, np.array(arm, dtype=float))


def test_windows_of_an_episode_follow_each_other_and_share_their_ends():
    # Two episodes of 10 steps; the state holds episode and time.
    snapshots = np.array([[[e, t] for e in range(2)] for t in range(11)], dtype=float)
    found = cut(snapshots, LENGTH)
    assert found.shape == (4, LENGTH + 1, 2)
    assert found[:, 0].tolist() == [[0, 0], [0, 5], [1, 0], [1, 5]]
    assert found[0, -1].tolist() == found[1, 0].tolist()


def test_a_replay_at_the_recorded_step_ends_where_the_recording_did(windows):
    task = task_at(DEFAULT)
    joints = [int(task.model.joint(name).qposadr[0]) for name in human.ARM_JOINTS]
    found = replay_windows(DEFAULT, windows, task=task)
    # Snapshots are float32.
    np.testing.assert_allclose(found.arm[:, :10], windows[:, -1, joints], atol=2e-4)


def test_a_finer_step_ends_elsewhere_and_the_finer_the_nearer(windows):
    ends = [
        replay_windows(one, windows, task=task_at(one)).arm[:, :10]
        for one in (*SETTINGS[:2], WINDOW_REFERENCE)
    ]
    errors = [np.abs(one - ends[-1]).mean() for one in ends[:2]]
    assert errors[0] > 1.5 * errors[1] > 0


def test_forces_do_not_count_before_contacts_have_forgotten_the_recorded_step(windows):
    still = windows[-4:].copy()
    first = replay_windows(DEFAULT, still[:, :2], task=task_at(DEFAULT))
    assert not first.impulse.any()
    assert replay_windows(DEFAULT, still, task=task_at(DEFAULT)).impulse.any()


def test_episodes_sum_their_windows_of_touch_alone():
    arm = np.zeros((4, 20))
    mine, reference = replayed([1, 2, 3, 4], arm), replayed([1, 1, 1, 1], arm)
    found = by_episode(mine, reference, np.array([True, False, True, True]), 2)
    assert found["touched"] == [1, 2]
    assert found["impulse"] == [1, 7]
    assert found["impulse_error"] == [0, 5]


def test_angles_are_measured_in_radians_and_in_canonical_deviations():
    deviations, _ = canonical_ruler()
    apart = np.zeros((2, 20))
    apart[0, :10] = 0.5 * deviations
    found = by_episode(
        replayed([0, 0], apart), replayed([0, 0], np.zeros((2, 20))), np.ones(2, bool), 1
    )
    assert found["angles"] == pytest.approx([0.25])  # Half of the windows.
    assert found["angles_rad"] == pytest.approx([0.25 * deviations.mean()])


def test_contacts_are_equally_stiff_and_damped_at_every_step(windows):
    states = windows[:, 0]
    found = [softness_of(task_at(one).model, states) for one in (*SETTINGS, WINDOW_REFERENCE)]
    assert found[0]["constraints"] > 0
    # Of a time constant of 0.04 s, a damping ratio of 1 and an impedance of 0.95.
    for one in found:
        assert one["stiffness"] == pytest.approx([1 / (0.95 * 0.04) ** 2] * 2)
        assert one["damping"] == pytest.approx([2 / (0.95 * 0.04)] * 2)


def test_contacts_that_state_no_softness_would_stiffen_with_the_step(windows):
    found = []
    for one in (DEFAULT, Setting(0.002)):
        model = task_at(one).model
        model.geom_solref[:, 0] = 0.02  # MuJoCo's default.
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
        found.append(softness_of(model, windows[:, 0])["stiffness"][1])
    assert found[1] == pytest.approx(4 * found[0])
