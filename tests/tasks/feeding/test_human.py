"""The head: its joints, its mouth, its impairments, and what naturalness sees of it."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import head, human, jaco
from rigid.tasks.feeding.task import Feeding

LIMITS_DEG = {"neck": (-10, 20), "head_x": (-50, 50), "head_y": (-34, 34), "head_z": (-70, 70)}


def moved(task, action, steps):
    """Head angles (steps, 4) of one world with a held action of the human."""
    world = task.make_world(1, threads=1)
    world.reset(np.array([3]))
    return np.array([
        world.step(np.zeros((1, 7)), np.array([action])).features[0, :4] for _ in range(steps)
    ])  # fmt: skip


@pytest.mark.parametrize("name", head.HEAD_JOINTS)
def test_joints_have_the_limits_of_the_original(task, name):
    np.testing.assert_allclose(np.rad2deg(task.model.joint(name).range), LIMITS_DEG[name])


@pytest.mark.parametrize(("body", "place"), [("male", -0.11), ("female", -0.10)])
def test_the_mouth_is_where_the_original_has_it(body, place):
    model = Feeding().with_parameters(body=body).model
    np.testing.assert_allclose(model.site(head.MOUTH_SITE).pos, (0, place, 0.03))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.site(head.MOUTH_SITE).xpos[1] < data.body(head.HEAD_BODY).xpos[1]  # It looks to -y.


def test_a_ball_as_wide_as_the_spoon_fits_into_the_mouth(task):
    data = mujoco.MjData(task.model)
    mujoco.mj_forward(task.model, data)
    middle = data.site(head.MOUTH_SITE).xpos
    geoms = [g for g in range(task.model.ngeom) if task.model.geom_contype[g]]
    own = task.model.body(head.HEAD_BODY).id
    reach = []
    for offset in np.random.default_rng(0).normal(size=(200, 3)) * (1, 0.2, 1):
        ray = offset / np.linalg.norm(offset)
        hit = np.zeros(1, dtype=np.int32)
        far = mujoco.mj_ray(task.model, data, middle, ray, None, 1, -1, hit)
        if far >= 0 and hit[0] in geoms and task.model.geom_bodyid[hit[0]] == own:
            reach.append(far)
    assert len(reach) > 50  # The others leave through the opening.
    assert min(reach) > 0.0179  # [m], half the width of the spoon's bowl.


def test_only_the_head_moves(task):
    driven = {task.model.joint(i).name for i in range(task.model.njnt)}
    assert driven == set(head.HEAD_JOINTS) | set(jaco.JOINT_NAMES)
    for part in human.RESTING_PARTS:
        assert task.model.body_weldid[task.model.body(part).id] == 0


def test_weakness_quarters_the_torque_of_the_head_and_not_of_the_robot():
    model = Feeding().with_parameters(impairment="weakness").model
    for name in head.HEAD_JOINTS:
        np.testing.assert_allclose(model.actuator(f"{name}_servo").forcerange, (-0.25, 0.25))
    np.testing.assert_allclose(model.actuator("jaco_joint_1_servo").forcerange, (-1, 1))


def test_limits_halve_the_range_and_starts_stay_within_it():
    task = Feeding().with_parameters(impairment="limits")
    np.testing.assert_allclose(task.model.joint("head_z").range, np.deg2rad((-35, 35)))
    world = task.make_world(32, threads=1)
    features = world.reset(np.arange(32)).features
    assert np.abs(features[:, 2]).max() <= np.deg2rad(17) + 1e-6


def test_tremor_moves_a_passive_head_to_and_fro(task):
    still = moved(task, np.zeros(4), 12)
    shaken = np.diff(moved(task.with_parameters(impairment="tremor"), np.zeros(4), 12), axis=0)
    np.testing.assert_allclose(np.ptp(still, axis=0), 0, atol=1e-6)
    strong = np.abs(shaken[5:]).max(axis=0) > 1e-3  # A heavy head nods less than it turns.
    assert strong.sum() >= 2
    assert (np.sign(shaken[5:-1, strong]) != np.sign(shaken[6:, strong])).mean() > 0.9


def test_features_are_the_head_alone(task, fed):
    _, rows, _ = fed
    assert task.feature_names[:4] == head.HEAD_JOINTS
    assert rows[-1].features.shape[1] == len(task.feature_names) == 8
    # A robot that moves and touches leaves a still person's head all but where it was.
    np.testing.assert_allclose(rows[0].features[:, :4], rows[30].features[:, :4], atol=1e-6)


@pytest.mark.parametrize(
    ("geom", "meets"),
    [("head_rest", True), ("spoon_bowl", True), ("jaco_link_7", True), ("chest", False)],
)
def test_the_head_meets_chair_and_robot_but_not_its_own_body(task, geom, meets):
    one, other = task.model.geom("skull"), task.model.geom(geom)
    bits = (one.contype[0] & other.conaffinity[0]) | (other.contype[0] & one.conaffinity[0])
    assert bool(bits) == meets
