"""The seated person has the original's size, limits and mass, at every percentile."""

import itertools

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import human
from rigid.tasks.bodies.sizes import BODIES
from tests.tasks.scripted import posed

JOINTS = ("right_upper_arm", "right_forearm", "right_hand")
# Right shoulder, elbow and wrist at the start, read from the running original [m].
MEASURED = {
    "male": [(-0.179, 0.030, 1.032), (-0.319, 0.030, 0.790), (-0.319, -0.260, 0.790)],
    "female": [(-0.159, 0.030, 0.992), (-0.291, 0.030, 0.763), (-0.291, -0.231, 0.763)],
}
LIMITS_DEG = {
    "pecs_x": (-10, 10),
    "pecs_y": (-10, 30),
    "pecs_z": (-35, 35),
    "shoulder_x": (5, 198),
    "shoulder_y": (-188, 61),
    "shoulder_z": (-90, 90),
    "elbow": (-128, 0),
    "forearm_roll": (-90, 90),
    "wrist_x": (-81, 90),
    "wrist_y": (-27, 47),
}
# Names and axes disagree: shoulder_x turns about y.
AXES = {"pecs_x": 0, "pecs_y": 1, "pecs_z": 2, "shoulder_x": 1, "shoulder_y": 0, "shoulder_z": 2,
        "elbow": 0, "forearm_roll": 2, "wrist_x": 0, "wrist_y": 1}  # fmt: skip
STATURE = {("male", 5.0): 1.643, ("male", 95.0): 1.869, ("female", 5.0): 1.523,
           ("female", 95.0): 1.735}  # fmt: skip  # ANSUR II means and deviations, normal [m].


@pytest.fixture(scope="module")
def person(task):
    """The task with another body; each is compiled once."""
    made = {("male", 50.0): task}

    def get(body, percentile=50.0):
        key = (body, percentile)
        if key not in made:
            made[key] = task.with_parameters(body=body, percentile=percentile)
        return made[key]

    return get


@pytest.mark.parametrize("body", ["male", "female"])
def test_the_right_arm_starts_where_the_original_has_it(person, body):
    data = posed(person(body))
    points = [data.body(name).xpos for name in JOINTS]
    np.testing.assert_allclose(points, MEASURED[body], atol=6e-4)  # Printed in millimetres.


def test_actions_are_in_the_order_of_the_originals_joints():
    assert tuple(LIMITS_DEG) == human.ARM_JOINTS


@pytest.mark.parametrize(("joint", "moves"), [("elbow", 0.29), ("forearm_roll", 0.0)])
def test_a_bent_elbow_carries_the_wrist_and_a_rolled_forearm_does_not(task, joint, moves):
    data = posed(task)
    before = data.body("right_hand").xpos.copy()
    data.qpos[task.model.joint(joint).qposadr[0]] += np.deg2rad(60)  # A chord as long as the arm.
    mujoco.mj_kinematics(task.model, data)
    moved = np.linalg.norm(data.body("right_hand").xpos - before)
    assert moved == pytest.approx(moves, abs=1e-6)


def test_limits_and_axes_of_the_arm(task):
    for name in human.ARM_JOINTS:
        joint = task.model.joint(name)
        np.testing.assert_allclose(np.rad2deg(joint.range), LIMITS_DEG[name], err_msg=name)
        assert np.argmax(joint.axis) == AXES[name], name
        assert joint.axis.max() == 1, name


@pytest.mark.parametrize("body", ["male", "female"])
def test_links_weigh_their_share_of_the_body(person, body):
    model, mass = person(body).model, BODIES[body].mass
    links = ("right_shoulder", *JOINTS)
    shares = [model.body(name).mass[0] / mass for name in links]
    np.testing.assert_allclose(shares, [0.05, 0.033, 0.019, 0.0065])


@pytest.mark.parametrize(("body", "percentile"), STATURE)
def test_lengths_follow_the_percentile_of_stature(person, body, percentile):
    mean = {"male": 1.756, "female": 1.629}[body]
    ratio = STATURE[body, percentile] / mean
    data, reference = posed(person(body, percentile)), posed(person(body))

    def forearm(scene):
        return np.linalg.norm(scene.body("right_hand").xpos - scene.body("right_forearm").xpos)

    # The wrist lies one radius, which follows the root of stature, beyond the forearm's length.
    assert forearm(data) / forearm(reference) == pytest.approx(ratio, rel=0.01)


@pytest.mark.parametrize(
    ("body", "percentile"),
    list(itertools.product(("male", "female"), (5.0, 50.0, 95.0))),
)
def test_nothing_touches_at_the_start_of_any_body(person, body, percentile):
    body_task = person(body, percentile)
    assert len(body_task.starts) >= 16
    for start in range(0, len(body_task.starts), 64):
        assert posed(body_task, start).ncon == 0


@pytest.mark.parametrize("limb", ["forearm", "upper_arm"])
def test_the_itch_lies_on_the_skin_in_the_middle_of_the_limb(task, limb):
    data, model = posed(task), task.model
    capsule = model.geom(f"right_{limb}")
    frame = data.geom(f"right_{limb}")
    local = frame.xmat.reshape(3, 3).T @ (data.site(f"itch_{limb}").xpos - frame.xpos)
    assert np.hypot(*local[:2]) == pytest.approx(capsule.size[0])
    assert local[2] == pytest.approx(0)


def test_nothing_but_the_right_arm_moves(task):
    moving = {task.model.body(body).name for body in task.model.jnt_bodyid}
    robot = {f"jaco_link_{number}" for number in range(1, 8)}
    assert moving - robot == {"right_shoulder", *JOINTS}


def test_the_arm_rests_on_the_chair_and_not_in_it(task):
    world = task.make_world(1, threads=1)
    world.reset(np.array([0]))
    press = np.zeros((1, 10))
    press[0, human.ARM_JOINTS.index("elbow")] = 1  # Straightens the elbow: the hand comes down.
    press[0, human.ARM_JOINTS.index("shoulder_y")] = 1
    deepest = 0.0
    for _ in range(30):
        world.step(np.zeros((1, 7)), press)
        deepest = max(deepest, world._scene.penetration(world._scene.records["sensordata"])[0])
    assert 0 < deepest < 0.01
    assert mujoco.mj_id2name(task.model, mujoco.mjtObj.mjOBJ_GEOM, 0) == "right_arm_rest"
