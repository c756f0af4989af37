"""The arm rests on the bed, and is driven as in itch scratching."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import bed, human, jaco
from rigid.tasks.bodies.jaco import Servo
from tests.tasks.playing import deepest_overlap


@pytest.mark.parametrize("parameters", [{}, {"body": "female"}, {"percentile": 95.0}])
def test_an_arm_at_rest_lies_on_the_bed_and_stays_there(task, parameters):
    task = task.with_parameters(**parameters)
    world = task.make_world(16, threads=1)
    before = world.reset(np.arange(16)).features
    data = mujoco.MjData(task.model)
    data.qpos[:] = world._batch.bind("qpos")[0]
    mujoco.mj_kinematics(task.model, data)
    hand = task.parameters.body_size.hand
    assert abs(data.geom("right_hand").xpos[2] - hand - bed.MATTRESS_TOP) < 0.02
    for _ in range(30):
        step = world.step(np.zeros((16, 7)), np.zeros((16, 10)))
    moved = np.abs(step.features - before)
    assert moved[:, :10].max() < np.deg2rad(2)
    assert moved[:, 10:].max() < 1e-3
    assert not step.faulted.any()


def test_an_arm_pressed_into_the_bed_stays_on_it(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    down, deepest = np.zeros((8, 10)), 0.0
    down[:, 4] = 1.0  # The shoulder extends.
    for _ in range(40):
        world.step(np.zeros((8, 7)), down)
        deepest = max(deepest, deepest_overlap(world))
    assert not world.faulted.any()
    assert deepest < 0.01


def test_servos_are_those_of_itch_scratching(task):
    for name in (*human.ARM_JOINTS, *jaco.JOINT_NAMES):
        servo = task.model.actuator(f"{name}_servo")
        assert servo.gainprm[0] / -servo.biasprm[2] == pytest.approx(Servo.RATE)
        np.testing.assert_array_equal(servo.forcerange, (-1, 1))
