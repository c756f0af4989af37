"""What each player sees: sizes of the original, frames, and nothing of which points are left."""

import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bed_bathing.observation import HUMAN_NAMES, ROBOT_NAMES
from rigid.tasks.bed_bathing.scene import ARM
from rigid.tasks.bodies import bed, wiper
from tests.tasks.playing import check_bounds, point


def test_both_see_as_many_numbers_as_in_the_original(task):
    assert task.robot.observation_size == 17 + 7
    assert task.human.observation_size == 18 + 10
    assert task.human.action_size == 10


def test_the_robot_sees_from_its_base(start):
    data, robot, _ = start
    base = np.array(bed.JACO_STAND)
    place = data.site(wiper.PAD_SITE).xpos
    np.testing.assert_allclose(point(robot, "pad"), place - base, atol=1e-6)
    for name, body in zip(("shoulder", "elbow", "wrist"), ARM, strict=True):
        seen = point(robot, f"{name}_position")
        np.testing.assert_allclose(seen, data.body(body).xpos - base, atol=1e-6)


def test_the_person_sees_from_the_chest_which_lies_on_its_back(task, start):
    data, _, person = start
    away = data.site(wiper.PAD_SITE).xpos - task.chest
    # What is above lies before the face, at -y; what is towards the head lies above.
    np.testing.assert_allclose(point(person, "pad"), (away[0], -away[2], away[1]), atol=1e-6)
    elbow = data.body("right_forearm").xpos - task.chest
    np.testing.assert_allclose(
        point(person, "elbow_position"), (elbow[0], -elbow[2], elbow[1]), atol=1e-6
    )


def test_the_pad_lies_level_at_the_start_and_upright_to_the_person(start):
    _, robot, person = start
    level = Rotation.from_quat([robot[f"pad_quaternion_{axis}"] for axis in "wxyz"],
                               scalar_first=True)  # fmt: skip
    np.testing.assert_allclose(level.apply((0, 0, 1)), (0, 0, 1), atol=0.02)
    felt = Rotation.from_quat([person[f"pad_quaternion_{axis}"] for axis in "wxyz"],
                              scalar_first=True)  # fmt: skip
    np.testing.assert_allclose(felt.apply((0, 0, 1)), (0, -1, 0), atol=0.02)


def test_everything_seen_lies_within_finite_bounds(task, bathed):
    check_bounds(task, bathed[1])


def test_forces_are_felt(bathed):
    _, rows, _ = bathed
    tool = np.array([step.robot_observation[:, ROBOT_NAMES.index("tool_force")] for step in rows])
    whole, pad = (
        np.array([step.human_observation[:, HUMAN_NAMES.index(name)] for step in rows])
        for name in ("force_on_person", "pad_force")
    )
    assert pad.max() > 1
    assert (pad <= whole + 1e-4).all()
    assert (pad <= tool + 1e-4).all()  # The wiper feels the bed as well.


def test_neither_sees_which_points_are_left(task):
    worlds = [task.make_world(1, threads=1) for _ in range(2)]
    for world in worlds:
        world.reset(np.array([2]))
    worlds[0].wiped[:] = True
    one, other = (world.step(np.zeros((1, 7)), np.zeros((1, 10))) for world in worlds)
    np.testing.assert_array_equal(one.robot_observation, other.robot_observation)
    np.testing.assert_array_equal(one.human_observation, other.human_observation)
    np.testing.assert_array_equal(one.features, other.features)
