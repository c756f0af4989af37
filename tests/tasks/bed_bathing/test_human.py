"""The person lies on the back: where the body is, what moves, and what naturalness sees of it."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bed_bathing.task import BedBathing
from rigid.tasks.bodies import bed, human, jaco, lying
from rigid.tasks.bodies.sizes import BODIES


@pytest.fixture(scope="module", params=[{}, {"body": "female"}, {"percentile": 95.0}])
def lain(request):
    """A body as its arm lies at rest: model and data."""
    task = BedBathing().with_parameters(**request.param)
    data = mujoco.MjData(task.model)
    angles = lying.start_angles(task.parameters.body_size)
    for name, angle in zip(human.ARM_JOINTS, angles, strict=True):
        data.joint(name).qpos = angle
    mujoco.mj_forward(task.model, data)
    return task, data


def test_the_person_lies_along_the_bed_face_up(lain):
    _, data = lain
    head, hips, foot = (data.geom(name).xpos for name in ("head", "hips", "left_foot"))
    assert head[1] > hips[1] + 0.5
    assert foot[1] < hips[1] - 0.7
    assert foot[2] > data.geom("left_shin").xpos[2]  # The toes point up.
    up = data.body("head").xmat.reshape(3, 3) @ (0, -1, 0)
    np.testing.assert_allclose(up, (0, 0, 1), atol=1e-9)
    assert data.body("right_upper_arm").xpos[0] < data.geom("chest").xpos[0]


def test_nothing_of_the_body_hangs_in_the_air_or_lies_deep_in_the_mattress(lain):
    task, data = lain
    for name, most in (("hips", 0.05), ("chest", 0.05), ("left_shin", 0.02), ("left_hand", 0.02)):
        geom = data.geom(name)
        radius = task.model.geom(name).size[0]
        assert -most < geom.xpos[2] - radius - bed.MATTRESS_TOP < 0.05


def test_nobody_sticks_in_the_ends_of_the_bed(lain):
    task, data = lain
    ends = [task.model.geom(name) for name in ("footboard", "headboard")]
    low = ends[0].pos[1] + ends[0].size[1]
    high = ends[1].pos[1] - ends[1].size[1]
    people = {task.model.body(part).id for part in lying.PARTS}
    for index in range(task.model.ngeom):
        if task.model.geom_bodyid[index] in people:
            box = task.model.geom_aabb[index].reshape(2, 3)[1]
            reach = np.abs(data.geom_xmat[index].reshape(3, 3)[1]) @ box
            assert data.geom_xpos[index, 1] - reach > low
            assert data.geom_xpos[index, 1] + reach < high


def test_only_the_right_arm_moves_and_every_part_is_there_once(lain):
    task, _ = lain
    driven = {task.model.joint(i).name for i in range(task.model.njnt)}
    assert driven == set(human.ARM_JOINTS) | set(jaco.JOINT_NAMES)
    names = [task.model.body(i).name for i in range(task.model.nbody)]
    assert all(names.count(part) == 1 for part in lying.PARTS)
    for part in ("torso", "head", "legs", "left_arm"):
        assert task.model.body_weldid[task.model.body(part).id] == 0


@pytest.mark.parametrize("body", sorted(BODIES))
def test_limits_halve_the_range_and_keep_the_start(body):
    size = BODIES[body]
    whole, half = lying.arm_limits(size, 1.0), lying.arm_limits(size, 0.5)
    np.testing.assert_allclose(whole, human.arm_limits(1.0))
    elbow = human.ARM_JOINTS.index("elbow")
    np.testing.assert_allclose(half[elbow], whole[elbow] / 2)
    start = lying.start_angles(size)
    assert ((half[:, 0] <= start) & (start <= half[:, 1])).all()


def test_impairments_reach_the_model():
    weak = BedBathing().with_parameters(impairment="weakness").model
    for name in human.ARM_JOINTS:
        np.testing.assert_allclose(weak.actuator(f"{name}_servo").forcerange, (-0.25, 0.25))
    np.testing.assert_allclose(weak.actuator("jaco_joint_1_servo").forcerange, (-1, 1))
    stiff = BedBathing().with_parameters(impairment="limits")
    np.testing.assert_allclose(stiff.model.joint("elbow").range, np.deg2rad((-64, 0)))
    features = stiff.make_world(16, threads=1).reset(np.arange(16)).features
    low, high = np.array([stiff.model.joint(name).range for name in human.ARM_JOINTS]).T
    assert ((features[:, :10] >= low - 1e-6) & (features[:, :10] <= high + 1e-6)).all()


def test_tremor_moves_a_passive_arm(task):
    def moved(one):
        world = one.make_world(1, threads=1)
        world.reset(np.array([3]))
        rows = [world.step(np.zeros((1, 7)), np.zeros((1, 10))).features[0] for _ in range(8)]
        return np.ptp(np.array(rows)[2:, :10], axis=0)

    assert moved(task).max() < np.deg2rad(0.5)
    assert moved(task.with_parameters(impairment="tremor")).max() > np.deg2rad(0.5)


def test_seeds_draw_different_arms_that_lie_on_the_bed(task):
    features = task.make_world(32, threads=1).reset(np.arange(32)).features[:, :10]
    start = lying.start_angles(task.parameters.body_size)
    turned = np.rad2deg(features - start)
    assert (np.abs(turned) < 5.7 + 1e-4).all()
    still = [human.ARM_JOINTS.index(name) for name in ("pecs_x", "pecs_z", "shoulder_y")]
    np.testing.assert_allclose(turned[:, still], 0, atol=1e-5)
    assert (np.ptp(np.delete(turned, still, axis=1), axis=0) > 4).all()
    fixed = task.with_parameters(arm_start_deg=0.0).make_world(4, threads=1)
    np.testing.assert_allclose(fixed.reset(np.arange(4)).features[:, :10], [start] * 4, atol=1e-6)


def test_features_are_the_arm_alone_with_units(task, bathed):
    _, rows, _ = bathed
    assert task.feature_names[:10] == human.ARM_JOINTS
    assert rows[-1].features.shape[1] == len(task.feature_names) == 20
    assert set(task.feature_units) == set(task.feature_names)
