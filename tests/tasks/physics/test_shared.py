"""What tasks on MuJoCo share: fine steps, addresses, tallies, and who is drawn as what."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.physics.again import FINE_STEP, fine_steps
from rigid.tasks.physics.scene import driven_addresses, floating_spec
from rigid.tasks.physics.tally import ForceTally


@pytest.mark.parametrize("control", [0.1, 0.0305, 0.0004])
def test_fine_steps_fill_a_control_step(control):
    step, count = fine_steps(control)
    assert step <= FINE_STEP
    assert step * count == pytest.approx(control)


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
