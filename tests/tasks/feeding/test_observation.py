"""What each player sees: sizes of the original, frames, and the mouth for both."""

import numpy as np

from rigid.tasks.bodies import head, spoon, wheelchair
from rigid.tasks.feeding.observation import HUMAN_NAMES, ROBOT_NAMES
from tests.tasks.playing import check_bounds, point


def test_both_see_as_many_numbers_as_in_the_original(task):
    assert task.robot.observation_size == 18 + 7
    assert task.human.observation_size == 19 + 4
    assert task.human.action_size == 4


def test_both_see_how_far_the_mouth_is(start):
    data, robot, person = start
    gap = data.site(spoon.SPOON_SITE).xpos - data.site(head.MOUTH_SITE).xpos
    np.testing.assert_allclose(point(person, "spoon_to_mouth"), gap, atol=1e-6)
    turned = np.array([-gap[1], gap[0], gap[2]])  # The robot's base is turned by -90°.
    np.testing.assert_allclose(point(robot, "spoon_to_mouth"), turned, atol=1e-6)


def test_the_robot_sees_from_its_base_and_the_human_from_the_chest(task, start):
    data, robot, person = start
    place = data.site(spoon.SPOON_SITE).xpos
    np.testing.assert_allclose(point(person, "spoon"), place - task.chest, atol=1e-6)
    away = place - np.array(wheelchair.JACO_MOUNT)
    np.testing.assert_allclose(point(robot, "spoon"), (-away[1], away[0], away[2]), atol=1e-6)
    face = data.body(head.HEAD_BODY)
    np.testing.assert_allclose(point(person, "head"), face.xpos - task.chest, atol=1e-6)
    quaternion = [person[f"head_quaternion_{axis}"] for axis in "wxyz"]
    np.testing.assert_allclose(quaternion, face.xquat, atol=1e-6)


def test_everything_seen_lies_within_finite_bounds(task, fed):
    check_bounds(task, fed[1])


def test_forces_are_felt(fed):
    _, rows, _ = fed
    felt = np.array([step.robot_observation[:, ROBOT_NAMES.index("spoon_force")] for step in rows])
    known = np.array([step.human_observation[:, HUMAN_NAMES.index("spoon_force")] for step in rows])
    np.testing.assert_array_equal(felt, known)
    assert felt.max() > 0
