"""Forces are what MuJoCo's contact list says; only spoon and mouth may touch."""

import numpy as np
import pytest

from rigid.tasks.bodies import head, spoon
from rigid.tasks.feeding.scene import PARTS
from rigid.tasks.feeding.sensing import LIPS, Sensors
from tests.tasks.contact_lists import substeps, swept, touches


def forces(model, data):
    """Normal force on the person, of the spoon, and at the mouth [N], from the contact list."""
    person, held, mouth = 0.0, 0.0, 0.0
    for force, place, names in touches(model, data, PARTS):
        near = np.linalg.norm(place - data.site(head.MOUTH_SITE).xpos) < LIPS
        person += force
        held += force * (spoon.SPOON_BODY in names)
        mouth += force * (names == {spoon.SPOON_BODY, head.HEAD_BODY} and bool(near))
    return person, held, mouth


@pytest.fixture(scope="module")
def pressed(task):
    """A blind robot sweeps over a person who keeps still."""
    return swept(task, 3, human_share=0.0)


@pytest.fixture(scope="module")
def presses(task, fed, pressed):
    """Contacts of every step in which somebody was touched."""
    del fed
    sensors = Sensors(task.model)
    return [(row, sensors.contacts(row[2])) for row in pressed[1]]


def test_forces_are_those_of_the_contact_list_at_every_physics_step(task, presses):
    found = 0
    for (state, control, recorded, step), seen in presses:
        touched = np.flatnonzero((seen.force_on_person.max(axis=1) > 0) & ~step.faulted)
        for index in touched[:2]:
            shown = substeps(task, state[index], control[index], recorded[index])
            for substep, data in enumerate(shown):
                kinds = (seen.force_on_person, seen.force_spoon, seen.force_mouth)
                one = [kind[index, substep] for kind in kinds]
                np.testing.assert_allclose(one, forces(task.model, data), atol=1e-9)
                found += one[0] > 0
    assert found > 50


def test_whatever_is_not_at_the_mouth_is_unwanted(presses):
    for _, seen in presses:
        rest = seen.force_on_person - seen.force_mouth
        np.testing.assert_allclose(seen.force_unwanted, rest, atol=1e-8)
        np.testing.assert_array_equal(seen.touched_unwanted, (seen.force_unwanted > 0).any(axis=1))


def test_peak_force_and_impulse_cover_every_physics_step(task, pressed, presses):
    world, rows = pressed
    alive = np.array([~step.faulted for *_, step in rows])[..., None]
    force = np.array([seen.force_on_person for _, seen in presses]) * alive
    ended = world.summary()
    np.testing.assert_allclose(ended.peak_force, force.max(axis=(0, 2)))
    impulse = force.sum(axis=(0, 2)) * task.parameters.physics_step
    np.testing.assert_allclose(ended.impulse, impulse)
    assert ended.peak_force.max() > 0


def test_a_blow_of_the_arm_is_an_unwanted_outcome(task, pressed):
    world, _ = pressed
    ended = world.summary()
    struck = (ended.extra["unwanted_contact_steps"] > 0) & (ended.success == 0)
    assert struck.any()
    names = {task.outcome_names[index] for index in ended.outcome[struck]}
    assert names == {"unwanted_contact"}


def test_a_spoon_in_the_mouth_hardly_ever_touches_anything_else(fed):
    world, rows, _ = fed
    assert max(step.info["force_mouth"].max() for step in rows[1:]) > 0
    assert (world.summary().extra["unwanted_contact_steps"] < 5).all()
