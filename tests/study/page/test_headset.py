"""Play in an emulated Quest 3 (IWER): the controller, or the hand itself, is the hand."""

import numpy as np
import pytest

from tests.study.page.conftest import IWER, STEPS
from tests.study.page.sessions import act, card, replayed, travelled, until

QUEST = """
const device = new IWER.XRDevice(IWER.metaQuest3);
device.installRuntime({ forceInstall: true });
device.stereoEnabled = false;
device.position.set(0, 1.25, 0);
window.quest = device;
// The sign, as read aloud beside it: what is said in the headset is said on the page too.
window.told = () => document.querySelector("[role=status][aria-live]").textContent;
"""
INPUTS = {
    "xr-controller": """
const held = device.controllers.right;
window.pull = (value) => held.updateButtonValue("trigger", value);
""",
    "xr-hand": """
device.primaryInputMode = "hand";
const held = device.hands.right;
window.pull = (value) => held.updatePinchValue(value);
""",
}
TOLERANCE = {"xr-controller": 0.05, "xr-hand": 0.15}
"""How far from its own origin an input has the palm [m], and some more."""


HOLD = """
window.hold = (x, y, z) => held.position.set(x, y, z);
window.hold(0.19, 1.0, -0.3);
"""


@pytest.fixture
def quest():
    """The script of a headset that is worn, without what the hand holds."""
    assert IWER.is_file(), "the emulated headset is not installed: run `npm --prefix web ci`"
    return IWER.read_text() + QUEST


def told(page, start: str) -> None:
    """Waits until the sign says something."""
    page.wait_for_function("start => window.told().startsWith(start)", arg=start)


def pull(page, *at: float) -> None:
    """Pulls the trigger, or pinches, with the hand at a place of the room [m]."""
    page.evaluate("at => window.hold(...at)", at)
    page.wait_for_timeout(150)
    page.evaluate("window.pull(1)")
    page.wait_for_timeout(150)
    page.evaluate("window.pull(0)")


@pytest.mark.slow
@pytest.mark.parametrize("device", INPUTS)
def test_the_hand_moves_the_arm_and_the_episode_is_what_the_server_simulated(
    invite, visit, quest, device
):
    participant = invite("player").ready()
    with visit(participant, quest + INPUTS[device] + HOLD) as page:
        card(page, "Episode 1 of 2")
        act(page, "vr")
        told(page, "Sit upright")
        pull(page, 0.19, 1.0, -0.3)
        told(page, "Put your hand on the seat")
        pull(page, 0.25, 0.47, 0.0)
        told(page, "Stretch your right arm")
        pull(page, 0.19, 1.06, -0.59)
        told(page, "Now in your own way")
        with participant.held():
            pull(page, 0.19, 1.0, -0.3)  # Wherever it points: that starts.
            until(page, lambda: len(page.targets) > 0)
            page.evaluate("window.hold(0.1, 1.0, -0.5)")
            travelled(page, 0.1)
        told(page, "Once more")

    (record,) = participant.episodes()
    stored = participant.service.store.participant(participant.code)
    assert record.device == device
    assert stored.calibration["seat_height"] == pytest.approx(0.47, abs=TOLERANCE[device])
    assert stored.calibration["arm_length"] == pytest.approx(0.68, abs=0.05 + TOLERANCE[device])
    assert len(record.arrays.targets) == STEPS
    # Forwards is where the person looks, −y in the world.
    first, last = record.arrays.targets[0], record.arrays.targets[-1]
    assert last[1] < first[1] - 0.05
    np.testing.assert_array_equal(replayed(record), record.arrays.states)
