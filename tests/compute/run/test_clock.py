"""Time adds up over the sessions of one measurement."""

from __future__ import annotations

import json
import subprocess
import sys
import time

import pytest

from rigid.compute.run.clock import Clock, core_seconds
from rigid.cores import count_helper
from rigid.errors import UserError


def test_a_clock_begins_near_zero():
    assert Clock().read()["wall_seconds"] < 60


def test_later_sessions_go_on_where_the_note_stopped(tmp_path):
    note = tmp_path / "groups" / "spent.json"
    note.parent.mkdir()
    note.write_text('{"core_seconds": 1000.0, "wall_seconds": 500.0}')
    clock = Clock()
    clock.go_on(note)
    assert clock.read()["core_seconds"] >= 1000
    clock.keep()
    assert json.loads(note.read_text())["wall_seconds"] >= 500


def test_a_first_session_leaves_a_note(tmp_path):
    clock = Clock()
    clock.go_on(tmp_path / "groups" / "spent.json")
    clock.keep()
    assert set(json.loads((tmp_path / "groups" / "spent.json").read_text())) == {
        "core_seconds", "wall_seconds", "driver_seconds",
    }  # fmt: skip


def test_a_note_of_before_the_drivers_time_was_counted_is_read(tmp_path):
    (tmp_path / "spent.json").write_text('{"core_seconds": 1000.0, "wall_seconds": 500.0}')
    clock = Clock()
    clock.go_on(tmp_path / "spent.json")
    assert clock.read()["driver_seconds"] == 0.0


def test_only_work_for_a_measurement_is_its_drivers_time():
    """Sleep stands for work, which takes wall time."""
    clock = Clock()
    time.sleep(0.3)
    with clock.working():
        time.sleep(0.3)
    found = clock.read()
    assert 0.3 <= found["driver_seconds"] <= found["wall_seconds"] - 0.2


def test_notes_are_not_taken_at_every_tick(tmp_path):
    clock = Clock()
    clock.go_on(tmp_path / "spent.json")
    clock.keep()
    (tmp_path / "spent.json").unlink()
    clock.tick()
    assert not (tmp_path / "spent.json").exists()


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"core_seconds": null, "wall_seconds": 1}'])
def test_a_damaged_note_is_named_with_its_cure(tmp_path, text):
    (tmp_path / "spent.json").write_text(text)
    with pytest.raises(UserError, match=r"spent\.json is damaged: delete it; only the times"):
        Clock().go_on(tmp_path / "spent.json")


BUSY = """
import sys, time
while time.process_time() < 0.5: pass
print(1, flush=True)
sys.stdin.read()
"""


def test_what_a_living_helper_has_done_counts_and_counts_once_when_it_has_ended():
    before = core_seconds()
    with subprocess.Popen(
        [sys.executable, "-c", BUSY], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as helper:
        count_helper(helper.pid)
        helper.stdout.readline()
        alive = core_seconds() - before
        assert alive > 0.45
    assert alive - 0.05 < core_seconds() - before < alive + 0.4
