"""Forces and contacts are what MuJoCo's contact list says, accumulated over the control step."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import human, jaco, scratcher
from rigid.tasks.bodies.collision import Role, assign
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.sensing import SCRATCH_RADIUS, Sensors
from tests.tasks.scripted import Scratcher, posed, still

PARTS = human.ARM_PARTS + human.TRUNK_PARTS


class Recount:
    """Adds up contacts from MuJoCo's contact list, independently of the sensors."""

    def __init__(self, model):
        self._model = model
        self._robot = model.body(jaco.BASE_BODY).id

    def forces(self, data, limb):
        """Normal force on the person, outside the arms and at the itch [N]; most on one part."""
        person, unwanted, at_itch, most = 0.0, 0.0, 0.0, 0
        count = dict.fromkeys(PARTS, 0)
        for index, contact in enumerate(data.contact):
            part = self._touched(contact)
            if part is None:
                continue
            force = np.zeros(6)
            mujoco.mj_contactForce(self._model, data, index, force)
            person += force[0]
            unwanted += force[0] * (part in human.TRUNK_PARTS)
            at_itch += force[0] * self._at_itch(data, contact, limb)
            count[part] += 1
            most = max(most, count[part])
        return np.array([person, unwanted, at_itch]), most

    def _touched(self, contact):
        bodies = self._model.geom_bodyid[list(contact.geom)]
        if self._robot not in self._model.body_rootid[bodies]:
            return None
        return next((p for p in PARTS if self._model.body(p).id in bodies), None)

    def _at_itch(self, data, contact, limb):
        geoms = {self._model.geom(geom).name for geom in contact.geom}
        scratching = geoms & {scratcher.TIP_GEOM, scratcher.ROD_GEOM}
        near = np.linalg.norm(contact.pos - data.site(f"itch_{limb}").xpos) < SCRATCH_RADIUS
        return scratching and f"right_{limb}" in geoms and near


@pytest.fixture(scope="module")
def scratched(task):
    """A scripted robot scratches 6 people for 50 steps: per step state, control, sensors, Step."""
    world = task.make_world(6, threads=1)
    step = world.reset(np.arange(6))
    robot, rows = Scratcher(task, world), []
    for _ in range(50):
        state = world._batch.state.copy()
        step = world.step(robot.act(world.itch), np.zeros((6, 10)))
        rows.append((state, world._batch.bind("ctrl").copy(),
                     world._scene.records["sensordata"].copy(), step))  # fmt: skip
    return world, rows


def test_forces_are_those_of_the_contact_list_at_every_physics_step(task, scratched):
    world, rows = scratched
    recount, sensors = Recount(task.model), Sensors(task.model)
    data, touched = mujoco.MjData(task.model), 0
    for state, control, recorded, _ in rows[5::5]:
        seen = sensors.contacts(recorded, world.itch)
        for index, limb in enumerate(world.itch):
            mujoco.mj_setState(
                task.model, data, state[index], mujoco.mjtState.mjSTATE_INTEGRATION.value
            )
            data.ctrl[:] = control[index]
            for substep in range(5):
                mujoco.mj_step(task.model, data)
                np.testing.assert_array_equal(data.sensordata, recorded[index, substep])
                expected, most = recount.forces(data, LIMBS[limb])
                forces = (seen.force_on_person, seen.force_unwanted, seen.force_itch)
                found = [force[index, substep] for force in forces]
                if most <= 3:  # More than three contacts on one part: the strongest are kept.
                    np.testing.assert_allclose(found, expected, atol=1e-9)
                touched += expected[2] > 0
    assert touched > 50


def test_a_robot_that_knows_the_itch_and_strokes_it_makes_counted_contacts(scratched):
    world, _ = scratched
    assert (world.counted >= 3).all()
    assert (world.contact_steps >= world.counted).all()
    assert set(world.itch) == {0, 1}


def test_the_wrong_limb_does_not_count(task):
    world = task.make_world(6, threads=1)
    world.reset(np.arange(6))
    robot, force = Scratcher(task, world), np.zeros(6)
    for _ in range(40):
        step = world.step(robot.act(1 - world.itch), np.zeros((6, 10)))
        force = np.maximum(force, step.info["force_on_person"])
    assert (force > 0).all()
    np.testing.assert_array_equal(world.contact_steps, 0)
    np.testing.assert_array_equal(world.summary().extra["counted_contacts"], 0)


def test_a_counted_contact_pays_in_the_step_that_counts_it(scratched):
    world, rows = scratched
    counted = np.array([step.info["counted"] for *_, step in rows])
    paid = np.array([step.info["reward_scratch"] for *_, step in rows])
    np.testing.assert_array_equal(paid, 5.0 * counted)
    np.testing.assert_array_equal(counted.sum(axis=0), world.counted)


def test_contacts_are_counted_from_the_last_counted_one(task, scratched):
    world, rows = scratched
    sensors, last = Sensors(task.model), np.zeros((6, 3))
    for _, _, recorded, step in rows:
        seen = sensors.contacts(recorded, world.itch)
        for index, counted in enumerate(step.info["counted"]):
            moved = np.linalg.norm(seen.itch_contact[index] - last[index])
            gentle = seen.force_itch[index].max() < 10
            assert counted == (seen.itch_touched[index] and gentle and moved > 0.01)
            if counted:
                last[index] = seen.itch_contact[index]


def test_peaks_cover_the_whole_control_step(scratched):
    _, rows = scratched
    peak = np.array([step.info["force_on_person"] for *_, step in rows])
    last = np.array([step.human_observation[:, -2] for *_, step in rows])
    assert (peak >= last * (1 - 1e-6)).all()
    # A hit that is over before the last physics step would otherwise be missed.
    assert (peak > last + 1).sum() > 5


def test_peak_force_and_impulse_of_an_episode_cover_every_physics_step(task, scratched):
    world, rows = scratched
    sensors = Sensors(task.model)
    force = np.array([sensors.contacts(row[2], world.itch).force_on_person for row in rows])
    summary = world.summary()
    np.testing.assert_allclose(summary.peak_force, force.max(axis=(0, 2)))
    np.testing.assert_allclose(summary.impulse, force.sum(axis=(0, 2)) * 0.02)


@pytest.fixture(scope="module")
def squeezed(task):
    """The scene with two robot fingers that squeeze the forearm from both sides."""
    pose = posed(task)
    hand, forearm = pose.body(jaco.HAND_BODY), pose.geom("right_forearm")
    spec = build_spec(task.parameters)
    sides = forearm.xmat.reshape(3, 3)[:, 0]
    reach = task.model.geom("right_forearm").size[0] + 0.019  # A millimetre deep.
    for sign in (-1, 1):
        place = forearm.xpos + sign * reach * sides
        geom = spec.body(jaco.HAND_BODY).add_geom(
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=(0.02, 0, 0),
            pos=hand.xmat.reshape(3, 3).T @ (place - hand.xpos),
        )
        assign(geom, Role.TOOL)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = pose.qpos
    data.ctrl[:] = pose.qpos
    mujoco.mj_forward(model, data)
    return model, data


def test_opposed_contacts_add_up(squeezed):
    model, data = squeezed
    normals, directions = [], []
    for index, contact in enumerate(data.contact):
        force = np.zeros(6)
        mujoco.mj_contactForce(model, data, index, force)
        normals.append(force[0])
        directions.append(contact.frame[:3] * np.sign(contact.pos[0]))
    assert len(normals) == 2
    assert min(normals) > 1
    seen = Sensors(model).contacts(data.sensordata[None, None], np.array([0]))
    assert seen.force_on_person[0, 0] == pytest.approx(sum(normals))
    assert seen.force_unwanted[0, 0] == 0


@pytest.fixture(scope="module")
def one_contact(task):
    """Sensors of one physics step: the tip touches `limb` at `place`, as seen from its itch."""
    sensors, model = Sensors(task.model), task.model

    def build(limb, place, force=2.0, geom=scratcher.TIP_GEOM):
        data = np.zeros(model.nsensordata)
        slot = model.sensor(f"{geom}_{limb}").adr[0]
        data[slot : slot + 7] = (1, force, 0, 0, *place)  # Found, force, position.
        return lambda itch: sensors.contacts(data[None, None], np.array([LIMBS.index(itch)]))

    return build


@pytest.mark.parametrize(
    ("distance", "near"), [(SCRATCH_RADIUS, False), (np.nextafter(SCRATCH_RADIUS, 0), True)]
)
def test_a_contact_must_be_nearer_to_the_itch_than_the_radius(one_contact, distance, near):
    seen = one_contact("forearm", (distance, 0, 0))("forearm")
    assert seen.itch_touched[0] == near
    assert seen.force_itch[0, 0] == (2.0 if near else 0.0)


@pytest.mark.parametrize("geom", [scratcher.TIP_GEOM, scratcher.ROD_GEOM])
@pytest.mark.parametrize("limb", LIMBS)
def test_tip_and_rod_scratch_the_itching_limb_only(one_contact, limb, geom):
    seen = one_contact(limb, (0.01, 0, 0), geom=geom)
    other = next(name for name in LIMBS if name != limb)
    assert seen(limb).itch_touched[0]
    np.testing.assert_array_equal(seen(limb).itch_contact[0], (0.01, 0, 0))
    assert not seen(other).itch_touched[0]
    assert seen(other).force_itch[0, 0] == 0


@pytest.mark.parametrize("part", PARTS)
def test_the_arms_may_be_touched_and_nothing_else(task, part):
    data = np.zeros((1, 1, task.model.nsensordata))
    data[0, 0, task.model.sensor(f"contact_{part}").adr[0]] = 5.0
    seen = Sensors(task.model).contacts(data, np.array([0]))
    unwanted = part not in {"right_upper_arm", "right_forearm", "right_hand", "left_arm"}
    assert seen.force_on_person[0, 0] == 5
    assert seen.force_unwanted[0, 0] == 5 * unwanted
    assert seen.touched_unwanted[0] == unwanted


def test_the_last_contact_of_the_step_is_the_one_that_counts(task):
    data = np.zeros((1, 3, task.model.nsensordata))
    slot = task.model.sensor(f"{scratcher.TIP_GEOM}_forearm").adr[0]
    data[0, 0, slot : slot + 7] = (1, 1, 0, 0, 0.001, 0, 0)
    data[0, 1, slot : slot + 7] = (1, 1, 0, 0, 0.002, 0, 0)
    seen = Sensors(task.model).contacts(data, np.array([LIMBS.index("forearm")]))
    np.testing.assert_array_equal(seen.itch_contact[0], (0.002, 0, 0))


def test_a_robot_that_stays_away_touches_nothing(task):
    world = task.make_world(4, threads=1)
    world.reset(np.arange(4))
    for _ in range(10):
        step = world.step(*still(4))
        np.testing.assert_array_equal(step.info["force_on_person"], 0)
    summary = world.summary()
    np.testing.assert_array_equal(summary.outcome, task.outcome_names.index("unhelped"))
    np.testing.assert_array_equal(summary.peak_force, 0)
