"""Groups in processes of this machine: the same numbers, and nothing lost when one is killed."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from select import PIPE_BUF

import cloudpickle
import loky
import pytest

from rigid.compute.executors.executor import WORTH_PROCESSES, Local, on_this_machine
from rigid.compute.executors.processes import Processes, can_be_sent
from rigid.errors import UserError
from tests.compute.tiny import Notes, measure_tiny, measured_once, without_times


def files_of(directory):
    return {path.relative_to(directory) for path in directory.rglob("*") if path.name != ".lock"}


def children():
    """Processes that this one started, by number."""
    tasks = Path("/proc/self/task").glob("*/children")
    return [int(number) for task in tasks for number in task.read_text().split()]


@pytest.fixture(scope="module")
def interrupted(base, tmp_path_factory):
    """A measurement in two processes, killed at the first group's first steps; and what it said."""
    out, notes = tmp_path_factory.mktemp("processes") / "run", Notes()

    def kill():
        for number in children():
            if b"LokyProcess" in Path(f"/proc/{number}/cmdline").read_bytes():
                os.kill(number, signal.SIGKILL)
        return False

    notes._stop = kill
    with pytest.raises(UserError) as caught:
        measure_tiny(base, out, executor=Processes(2), listener=notes)
    return out, str(caught.value)


@pytest.fixture(scope="module")
def sent():
    """Bytes of what was sent to processes."""
    return []


@pytest.fixture(scope="module")
def resumed(base, interrupted, sent):
    """The same measurement, gone on with in two processes."""
    notes = Notes()
    out, _ = interrupted
    submit = loky.ProcessPoolExecutor.submit

    def noted(pool, *what):
        sent.append(len(cloudpickle.dumps(what)))
        return submit(pool, *what)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loky.ProcessPoolExecutor, "submit", noted)
        return measure_tiny(base, out, executor=Processes(2), listener=notes), notes


def test_a_process_that_is_killed_is_named_with_the_cure(interrupted):
    out, message = interrupted
    assert message.startswith("the process of group s")
    assert message.endswith(
        f"-r1 of {out} was killed, perhaps for want of memory: the same command goes on"
    )


def test_processes_leave_the_numbers_and_files_of_a_single_process(base, resumed):
    frontier, _ = resumed
    alone = measured_once(base, "alone", executor=Local())
    assert without_times(frontier) == without_times(alone)
    assert files_of(frontier.directory) | {Path("report.html")} == files_of(alone.directory)


@pytest.mark.usefixtures("resumed")
def test_what_is_sent_fits_a_pipe_that_nobody_empties(sent):
    """Else a thread waits in it when the processes are killed, and never gives back its locks."""
    assert sent
    assert max(sent) < PIPE_BUF


def test_every_step_is_told_and_their_time_counted(resumed):
    frontier, notes = resumed
    assert notes.complete
    assert frontier.data["core_seconds"] > 0
    assert any(text == "2 processes, a core for each" for text in notes.lines)


def test_no_process_outlives_the_measurement(resumed):
    del resumed
    ours = [Path(f"/proc/{number}/cmdline").read_bytes() for number in children()]
    assert not [line for line in ours if b"LokyProcess" in line]


@pytest.mark.parametrize(
    ("searches", "env_steps", "luggage"),
    [(1, WORTH_PROCESSES, "robot"), (3, WORTH_PROCESSES - 1, "robot")],
    ids=["a single seed", "little to do"],
)
def test_one_process_does_what_gains_nothing_from_more(searches, env_steps, luggage):
    assert isinstance(on_this_machine(searches, env_steps, luggage), Local)


def test_what_cannot_be_sent_stays_in_one_process(tmp_path):
    with (tmp_path / "open").open("w") as file:
        assert not can_be_sent(file)
        assert isinstance(on_this_machine(9, WORTH_PROCESSES, file), Local)


def test_many_seeds_get_a_process_for_each_core_or_seed(monkeypatch):
    monkeypatch.setattr("rigid.cores.cores", lambda: [0, 1, 2])
    assert on_this_machine(2, WORTH_PROCESSES, "robot") == Processes(2)
    assert on_this_machine(1000, WORTH_PROCESSES, "robot") == Processes(3)
