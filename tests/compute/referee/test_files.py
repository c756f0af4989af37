"""Stored referees judge again, and say the same."""

from __future__ import annotations

import json

import jax.numpy as jnp
import numpy as np
import pytest

from rigid.compute.referee.files import load_panel, rejudge, save_panel
from rigid.errors import UserError
from rigid.naturalness.panel import Jury, naturalness
from rigid.naturalness.rates import Rate
from rigid.naturalness.referee import Referee
from rigid.naturalness.standardise import Scale
from rigid.naturalness.views import all_sound

RNG = np.random.default_rng(0)
EPISODES = all_sound(RNG.standard_normal((6, 20, 2)).astype(np.float32))


def referee(length, view, inputs):
    layer = {
        "w": jnp.asarray(RNG.standard_normal((inputs, 1)), jnp.float32),
        "b": jnp.zeros(1),
    }
    scale = Scale(np.zeros(inputs, np.float32), np.eye(inputs, dtype=np.float32))
    return Referee([layer], scale, length, view)


def panel():
    alarms = {1.0: Rate(0.25, 0.125), 4.0: Rate(0.0625, None)}
    return {
        "step": Jury((referee(1, "flat", 2), referee(1, "flat", 2)), alarms),
        "window16": Jury((referee(16, "summary", 8),), {16.0: Rate(0.0, 0.0)}),
    }


@pytest.fixture
def stored(tmp_path):
    found = panel()
    save_panel(tmp_path, "s0-r1-l1", found, ("hand", "goal"))
    return found


def test_stored_referees_say_what_they_said(stored, tmp_path):
    expected = naturalness(stored, EPISODES)
    assert 0 < expected["step_k1"].value < 1
    assert rejudge(tmp_path, "s0-r1-l1", EPISODES) == expected


def test_referees_of_a_run_can_be_read(small_run):
    found = load_panel(small_run.directory / "referee", "s0-r1-l1")
    assert set(found) == {"step"}  # Episodes of the toy are shorter than a window.
    assert found["step"].referees[0].scale.mean.shape == (2,)


def test_a_card_that_promises_more_than_is_stored_is_refused(stored, tmp_path):
    del stored
    path = tmp_path / "s0-r1-l1.json"
    card = json.loads(path.read_text())
    card["levels"]["step"]["referees"].append({"view": "flat", "layers": 1})
    path.write_text(json.dumps(card))
    with pytest.raises(UserError, match="has no 'step/2/layer0/w', which its card promises"):
        load_panel(tmp_path, "s0-r1-l1")


def test_damaged_arrays_are_refused(stored, tmp_path):
    del stored
    (tmp_path / "s0-r1-l1.safetensors").write_bytes(b"nothing")
    with pytest.raises(UserError, match=r"s0-r1-l1\.safetensors is damaged"):
        load_panel(tmp_path, "s0-r1-l1")
