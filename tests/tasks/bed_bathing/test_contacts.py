"""Forces and places are what MuJoCo's contact list says; only pad and right arm may touch."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bed_bathing.points import LIMBS
from rigid.tasks.bed_bathing.scene import ARM
from rigid.tasks.bed_bathing.sensing import Sensors
from rigid.tasks.bodies import jaco, lying, wiper


def seen_in(model, data):
    """Normal force on the person and of the pad on the arm [N], and the places of its touches."""
    robot = model.body(jaco.BASE_BODY).id
    person, pad, places, force = 0.0, 0.0, [], np.zeros(6)
    for index, contact in enumerate(data.contact):
        bodies = model.geom_bodyid[list(contact.geom)]
        names = {model.body(int(body)).name for body in bodies}
        if robot not in model.body_rootid[bodies] or not names & set(lying.PARTS):
            continue
        mujoco.mj_contactForce(model, data, index, force)
        person += force[0]
        (part,) = names & set(lying.PARTS)
        if wiper.PAD_BODY in names and part in ARM:
            pad += force[0]
            turned = data.body(part).xmat.reshape(3, 3)
            if part.removeprefix("right_") in LIMBS:
                places.append(turned.T @ (contact.pos - data.body(part).xpos))
    return person, pad, np.array(places).reshape(-1, 3)


@pytest.fixture(scope="module")
def pressed(task):
    """A robot sweeps over the person: state and control before a step, its sensors, the step.

    Random but steady actions of both players.
    """
    world, rng = task.make_world(24, threads=1), np.random.default_rng(5)
    world.reset(np.arange(24))
    rows, action = [], np.zeros((24, 17))
    for number in range(100):
        if number % 25 == 0:
            action = rng.choice([-1.0, 1.0], (24, 17)) * rng.uniform(0.2, 1, (24, 17))
        state = world._batch.state.copy()
        step = world.step(action[:, :7], 0.5 * action[:, 7:])
        data = world._scene.records["sensordata"].copy()
        rows.append((state, world._batch.bind("ctrl").copy(), data, step))
    return world, rows


def test_forces_and_places_are_those_of_the_contact_list_at_every_physics_step(task, pressed):
    data, sensors, touched, wiped = mujoco.MjData(task.model), Sensors(task.model), 0, 0
    for state, control, recorded, step in pressed[1]:
        seen = sensors.contacts(recorded)
        pad = (seen.force_pad.max(axis=1) > 0) & ~step.faulted
        other = (seen.force_on_person.max(axis=1) > 0) & ~step.faulted
        for index in [*np.flatnonzero(pad)[:2], *np.flatnonzero(other)[:1]]:
            flag = mujoco.mjtState.mjSTATE_INTEGRATION.value
            mujoco.mj_setState(task.model, data, state[index], flag)
            data.ctrl[:] = control[index]
            for substep in range(5):
                mujoco.mj_step(task.model, data)
                np.testing.assert_array_equal(data.sensordata, recorded[index, substep])
                person, force, places = seen_in(task.model, data)
                found = seen.force_on_person[index, substep], seen.force_pad[index, substep]
                np.testing.assert_allclose(found, (person, force), atol=1e-9)
                mine = seen.places[index, substep][seen.touching[index, substep]]
                assert len(mine) == len(places)
                for place in places:
                    np.testing.assert_allclose(np.abs(mine - place).sum(axis=1).min(), 0, atol=1e-9)
                touched, wiped = touched + (person > 0), wiped + len(places)
    assert touched > 50
    assert wiped > 20


def test_touches_lie_on_the_skin_of_their_limb(task, bathed):
    world, _, _ = bathed
    sensors = Sensors(task.model)
    size = task.parameters.body_size
    seen = sensors.contacts(world._scene.records["sensordata"])
    for limb, radius in enumerate((size.upper_arm[0], size.forearm[0])):
        places = seen.places[:, :, limb][seen.touching[:, :, limb]]
        if len(places):
            off_axis = np.linalg.norm(places[:, :2], axis=1)
            assert (off_axis < radius + 0.002).all()
            assert (off_axis > radius - 0.01).all()


def test_whatever_is_not_pad_on_arm_is_unwanted(task, pressed):
    sensors, struck = Sensors(task.model), 0
    for *_, recorded, _ in pressed[1]:
        seen = sensors.contacts(recorded)
        rest = seen.force_on_person - seen.force_pad
        np.testing.assert_allclose(seen.force_unwanted, rest, atol=1e-8)
        np.testing.assert_array_equal(seen.touched_unwanted, (seen.force_unwanted > 0).any(axis=1))
        struck += seen.touched_unwanted.sum()
    assert struck > 0


def test_a_blow_of_the_arm_is_an_unwanted_outcome(task, pressed):
    ended = pressed[0].summary()
    struck = (ended.extra["unwanted_contact_steps"] > 0) & (ended.success == 0)
    assert struck.any()
    names = {task.outcome_names[index] for index in ended.outcome[struck]}
    assert names == {"unwanted_contact"}
