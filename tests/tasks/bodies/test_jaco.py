"""The Jaco has the published shape, limits and masses."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import jaco, scratcher
from rigid.tasks.itch_scratching.starts import STARTS
from tests.tasks.scripted import posed


@pytest.fixture
def arm(task):
    return STARTS.kinematics(task.model)


def test_the_straight_arm_reaches_as_high_as_the_published_one(task, arm):
    position, _ = arm.pose(np.array([0, np.pi, 0, np.pi, 0, np.pi, 0]))
    base = task.model.body(jaco.BASE_BODY).pos
    assert position[2] - base[2] == pytest.approx(1.2603, abs=1e-4)


def test_a_start_found_by_the_original_lies_in_the_goal_box(arm):
    # Printed by the running original, to two decimals.
    position, rotation = arm.pose(np.array([1.65, 1.68, 5.16, 2.07, 3.21, 1.19, 2.06]))
    assert np.abs(position - STARTS.goal).max() < STARTS.spread
    assert (STARTS.rotation.inv() * rotation).magnitude() < np.deg2rad(3)


def test_joint_limits_are_the_published_ones(arm):
    turn = 2 * np.pi
    expected = [
        (-turn, turn), (0.8203, 5.4629), (-turn, turn), (0.5236, 5.7596), (-turn, turn),
        (1.1345, 5.1487), (-turn, turn),
    ]  # fmt: skip
    np.testing.assert_allclose(arm.limits, expected)


def test_link_masses_are_the_published_ones(task):
    masses = [task.model.body(f"jaco_link_{number}").mass[0] for number in range(1, 8)]
    np.testing.assert_allclose(masses, [0.7477, 0.8447, 0.8447, 0.6763, 0.463, 0.463, 0.990])


def test_the_base_stands_beside_the_chair_and_faces_the_person(task):
    base = task.model.body(jaco.BASE_BODY)
    np.testing.assert_allclose(base.pos, (-0.35, -0.30, 0.36))
    yaw = Rotation.from_quat(base.quat, scalar_first=True).as_euler("xyz", degrees=True)[2]
    assert yaw == pytest.approx(-90)


def test_the_scratcher_points_out_of_the_palm(task):
    data = posed(task)
    end, tip = data.site(jaco.END_EFFECTOR_SITE), data.site(scratcher.TIP_SITE)
    palm = end.xmat.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(tip.xpos - end.xpos, 0.095 * palm, atol=1e-12)
    np.testing.assert_allclose(tip.xmat.reshape(3, 3)[:, 0], palm, atol=1e-12)
    assert task.model.body("scratcher").mass[0] == pytest.approx(0.3)


def test_every_start_lies_in_the_goal_box_with_the_palm_towards_the_arm(task, arm):
    poses = [arm.pose(angles) for angles in task.starts]
    misses = np.array([position - STARTS.goal for position, _ in poses])
    turns = np.array([(STARTS.rotation.inv() * rotation).magnitude() for _, rotation in poses])
    assert np.abs(misses).max() < STARTS.spread
    assert turns.max() < np.deg2rad(1)


def test_starts_leave_every_joint_room_to_its_limits(task, arm):
    room = np.minimum(task.starts - arm.limits[:, 0], arm.limits[:, 1] - task.starts)
    assert room.min() > 0.14


def test_neighbouring_links_do_not_touch_at_any_start(task):
    for start in range(0, len(task.starts), 32):
        assert posed(task, start).ncon == 0


def test_a_quaternion_is_fixed_axis_roll_pitch_yaw():
    angles = (0.3, -1.1, 2.0)
    expected = Rotation.from_euler("xyz", angles).as_quat(scalar_first=True)
    np.testing.assert_allclose(jaco.quaternion(angles), expected)


def test_the_arm_is_driven_by_one_servo_a_joint(task):
    for name in jaco.JOINT_NAMES:
        actuator = task.model.actuator(f"{name}_servo")
        assert actuator.trntype[0] == mujoco.mjtTrn.mjTRN_JOINT
        assert actuator.trnid[0] == task.model.joint(name).id
