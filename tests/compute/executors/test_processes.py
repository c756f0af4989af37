"""Groups in processes of this machine: the same numbers, and nothing lost when one is killed."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from select import PIPE_BUF

import cloudpickle
import loky
import pytest
from loky.process_executor import TerminatedWorkerError

from rigid.compute.executors.executor import WORTH_PROCESSES, Local, on_this_machine
from rigid.compute.executors.processes import Processes, _starting, can_be_sent
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


def test_whatever_refuses_to_be_pickled_stays_in_one_process():
    pointer = ctypes.pointer(ctypes.c_int(1))
    with pytest.raises(ValueError, match="pointers cannot be pickled"):
        cloudpickle.dumps(pointer)
    assert not can_be_sent(pointer)


def signals_of_a_worker():
    """Which signals wait, what SIGTERM does, and how a process ends that it starts and ends."""
    waiting = signal.pthread_sigmask(signal.SIG_BLOCK, [])
    os.kill(os.getpid(), signal.SIGTERM)
    child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    child.terminate()
    return waiting, child.wait(30)


def test_workers_outlive_a_termination_signal_and_can_end_what_they_start():
    """A scheduler sends it to all processes; the driver is who ends its workers."""
    with Processes(2).workers() as workers, _starting():
        found = workers._pool.submit(signals_of_a_worker).result(timeout=60)
    assert found == (set(), -signal.SIGTERM)


def test_signals_wait_while_the_first_worker_starts():
    script = (
        "import signal\n"
        "from rigid.compute.executors import processes\n"
        "with processes.Processes(2).workers() as workers:\n"
        "    with processes._starting():\n"
        "        done = workers._pool.submit(int)\n"
        "        print(sorted(signal.pthread_sigmask(signal.SIG_BLOCK, [])))\n"
        "    print(sorted(signal.pthread_sigmask(signal.SIG_BLOCK, [])), done.result())\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=120
    )
    waiting, afterwards = done.stdout.splitlines()
    assert waiting == str([signal.SIGINT, signal.SIGTERM])
    assert afterwards == "[] 0"


def test_a_process_that_is_killed_before_a_group_is_handed_out_is_told_too(base, tmp_path):
    """Not only where a group is waited for."""

    class Tired(Processes):
        @contextmanager
        def workers(self):
            with super().workers() as workers:
                done = workers._pool.submit(os._exit, 1)
                with pytest.raises(TerminatedWorkerError):
                    done.result(timeout=60)
                yield workers

    with pytest.raises(UserError, match=r"the process of group s0-r1 of .* was killed, perhaps"):
        measure_tiny(base, tmp_path / "run", executor=Tired(2), listener=Notes())


def test_many_seeds_get_a_process_for_each_core_or_seed(monkeypatch):
    monkeypatch.setattr("rigid.cores.cores", lambda: [0, 1, 2])
    assert on_this_machine(2, WORTH_PROCESSES, "robot") == Processes(2)
    assert on_this_machine(1000, WORTH_PROCESSES, "robot") == Processes(3)
