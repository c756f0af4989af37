"""What tasks on MuJoCo share: fine steps, addresses, tallies, and who is drawn as what."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import wheelchair
from rigid.tasks.physics.again import FINE_STEP, fine_steps
from rigid.tasks.physics.observing import bounds, frame, seen_by_robot, turned_for_robot
from rigid.tasks.physics.parameters import finely
from rigid.tasks.physics.scene import PENETRATION, driven_addresses, floating_spec
from rigid.tasks.physics.sensing import penetration_reader
from rigid.tasks.physics.tally import ForceTally
from rigid.tasks.registry import make_task


@pytest.mark.parametrize("control", [0.1, 0.0305, 0.0004])
def test_fine_steps_fill_a_control_step(control):
    step, count = fine_steps(control)
    assert step <= FINE_STEP
    assert step * count == pytest.approx(control)


@pytest.mark.parametrize("name", ["itch-scratching", "feeding", "bed-bathing"])
def test_finer_parameters_keep_everything_but_the_physics_step(name):
    given = make_task(name, percentile=60, impairment="tremor", substeps=4).parameters
    fine = finely(given)
    assert fine.physics_step <= FINE_STEP
    assert fine.control_period == pytest.approx(given.control_period)
    assert replace(fine, physics_step=0.02, substeps=4) == given


def test_an_observed_number_has_the_bounds_of_its_kind():
    names = (*frame("tip"), "elbow", "force_on_person")
    low, high = bounds(names, {"elbow": np.array([-1.0, 2.0])}).T
    np.testing.assert_allclose(high, [3, 3, 3, 1, 1, 1, 1, 2.2, 1000])
    np.testing.assert_allclose(low, [-3, -3, -3, -1, -1, -1, -1, -1.2, 0])


@pytest.mark.parametrize("stand", [(), ((1.0, -2.0, 0.5), 0.7)], ids=["wheelchair", "elsewhere"])
def test_the_robot_sees_from_its_base(stand):
    base, yaw = stand or (wheelchair.JACO_MOUNT, wheelchair.JACO_YAW)
    turned = Rotation.from_euler("z", yaw)
    places = np.array([[base, base + turned.apply([0.1, 0.0, 0.2])]])
    seen = seen_by_robot(places, *stand)
    np.testing.assert_allclose(seen, [[[0, 0, 0], [0.1, 0, 0.2]]], atol=1e-12)
    straight = turned_for_robot(turned.as_quat(scalar_first=True)[None], *stand[1:])
    np.testing.assert_allclose(np.abs(straight), [[1, 0, 0, 0]], atol=1e-12)


@pytest.mark.parametrize("name", ["itch-scratching", "feeding", "bed-bathing"])
def test_the_deepest_overlap_of_a_control_step_counts(name):
    model = make_task(name).model
    data = np.zeros((2, 3, model.nsensordata))
    sensors = [model.sensor(i) for i in range(model.nsensor)]
    first, last = [one for one in sensors if one.name.startswith(PENETRATION)]
    data[0, 1, first.adr[0]], data[1, 2, last.adr[0]] = -0.03, -0.01
    np.testing.assert_array_equal(penetration_reader(model)(data), [0.03, 0.01])


def test_joints_that_are_not_driven_in_order_are_refused():
    spec = floating_spec("swapped", 0.01)
    for name in ("one", "two"):
        body = spec.worldbody.add_body(name=name)
        body.add_joint(name=name)
        body.add_geom(size=(0.1, 0, 0))
    for name in ("two", "one"):
        spec.add_actuator(name=f"{name}_servo", target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    with pytest.raises(ValueError, match=r"joints \('one', 'two'\) are not driven in order"):
        driven_addresses(spec.compile(), ("one", "two"))


def test_a_tally_keeps_peaks_and_adds_impulses_of_worlds_that_count():
    tally = ForceTally(2)
    alive = np.array([True, False])
    for force in (1.0, 3.0, 2.0):
        steps = np.full((2, 5), force)
        tally.add(steps, np.array([force > 2, True]), alive, physics_step=0.02)
    np.testing.assert_array_equal(tally.peak, [3, 0])
    np.testing.assert_allclose(tally.impulse, [0.6, 0])
    np.testing.assert_array_equal(tally.unwanted_steps, [1, 0])
