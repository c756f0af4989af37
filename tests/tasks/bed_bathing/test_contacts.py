"""Forces and places are what MuJoCo's contact list says; only pad and right arm may touch."""

import numpy as np
import pytest

from rigid.tasks.bed_bathing.points import LIMBS
from rigid.tasks.bed_bathing.scene import ARM
from rigid.tasks.bed_bathing.sensing import Sensors
from rigid.tasks.bodies import lying, wiper
from tests.tasks.contact_lists import substeps, swept, touches


def seen_in(model, data):
    """Normal force on the person and of the pad on the arm [N], and the places of its touches."""
    person, pad, places = 0.0, 0.0, []
    for force, place, names in touches(model, data, lying.PARTS):
        person += force
        (part,) = names & set(lying.PARTS)
        if wiper.PAD_BODY in names and part in ARM:
            pad += force
            turned = data.body(part).xmat.reshape(3, 3)
            if part.removeprefix("right_") in LIMBS:
                places.append(turned.T @ (place - data.body(part).xpos))
    return person, pad, np.array(places).reshape(-1, 3)


@pytest.fixture(scope="module")
def pressed(task):
    """A robot sweeps over a person who moves half as much."""
    return swept(task, 5, human_share=0.5)


def test_forces_and_places_are_those_of_the_contact_list_at_every_physics_step(task, pressed):
    sensors, touched, wiped = Sensors(task.model), 0, 0
    for state, control, recorded, step in pressed[1]:
        seen = sensors.contacts(recorded)
        pad = (seen.force_pad.max(axis=1) > 0) & ~step.faulted
        other = (seen.force_on_person.max(axis=1) > 0) & ~step.faulted
        for index in [*np.flatnonzero(pad)[:2], *np.flatnonzero(other)[:1]]:
            shown = substeps(task, state[index], control[index], recorded[index])
            for substep, data in enumerate(shown):
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
