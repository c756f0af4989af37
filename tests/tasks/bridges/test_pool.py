"""Worlds in several processes: the same numbers, and clear words when one of them fails."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
from multiprocessing import Pipe

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.tasks.bridges.desk import Sizes, serve
from rigid.tasks.bridges.pool import FEWEST, Pool
from rigid.tasks.registry import make_task

HERE = "pettingzoo:tests.tasks.bridges.environments"
BATCH = 2 * FEWEST + 1  # Two processes, of which one has a world more.


@pytest.fixture(scope="module")
def task():
    """Episodes end at different times, so that some processes have nothing to do for a while."""
    return make_task(f"{HERE}:beyond")


def play(task, threads, seeds=None):
    world = task.make_world(BATCH, threads=threads)
    rng = np.random.default_rng(0)
    steps = [world.reset(np.arange(BATCH) if seeds is None else seeds)]
    for _ in range(task.horizon):
        steps.append(world.step(*rng.uniform(-1, 1, (2, BATCH, 1))))
    return np.stack([np.column_stack([*step[:4], step.faulted]) for step in steps])


def is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_numbers_do_not_depend_on_the_number_of_processes(task):
    alone = play(task, 1)
    np.testing.assert_array_equal(play(task, 2), alone)


def test_environments_are_used_again_and_remember_nothing(task):
    first = play(task, 1)
    play(task, 1, seeds=np.arange(BATCH) + 50)
    np.testing.assert_array_equal(play(task, 1), first)
    gc.collect()
    play(task, 1)
    assert len(task._pool._here._desk._leases) <= 2


def test_one_process_is_this_one():
    pool = Pool(make_task(f"{HERE}:two")._opener, "name", Sizes(2, 2, 3))
    for batch, threads in ((100, 1), (FEWEST, 4)):
        pool.lease(batch, threads).reset(np.arange(batch))
    assert pool._workers == []


def test_two_worlds_of_one_task_do_not_disturb_each_other(task):
    first, second = (task.make_world(2, threads=1) for _ in range(2))
    start = first.reset(np.array([1, 2]))
    second.reset(np.array([3, 4]))
    still = np.zeros((2, 1))
    moved = first.step(still - 0.5, still - 0.5)
    np.testing.assert_array_equal(moved.robot_observation[:, 0], start.robot_observation[:, 0])


@pytest.mark.parametrize("threads", [1, 2])
def test_a_mistake_is_named_with_seed_and_step(threads):
    task = make_task(f"{HERE}:failing")
    world = task.make_world(BATCH, threads=threads)
    world.reset(np.arange(BATCH) + 70)
    actions = np.zeros((2, BATCH, 1))
    world.step(*actions)
    message = (
        r"environments:failing: the environment fails at step 2 of the episode of seed 70: "
        r"ZeroDivisionError: a stranger's mistake \(.*environments\.py:\d+\)"
    )
    with pytest.raises(UserError, match=message):
        world.step(*actions)


def test_a_killed_process_is_noticed():
    task = make_task(f"{HERE}:two")
    world = task.make_world(BATCH, threads=2)
    world.reset(np.arange(BATCH))
    os.kill(task._pool._workers[0]._process.pid, signal.SIGKILL)
    task._pool._workers[0]._process.join(timeout=30)
    with pytest.raises(UserError, match="a process that steps its environments was killed"):
        world.step(*np.zeros((2, BATCH, 1)))


def test_a_new_world_after_a_killed_process_has_a_new_one():
    task = make_task(f"{HERE}:two")
    expected = play(task, 2)
    os.kill(task._pool._workers[1]._process.pid, signal.SIGKILL)
    task._pool._workers[1]._process.join(timeout=30)
    np.testing.assert_array_equal(play(task, 2), expected)


@pytest.mark.parametrize("method", ["ask", "answer"])
def test_answers_to_an_interrupted_question_are_never_taken_for_others(task, monkeypatch, method):
    expected = play(task, 2)
    world = task.make_world(BATCH, threads=2)
    world.reset(np.arange(BATCH) + 50)
    second = task._pool._workers[1]

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(second, method, interrupted)
    with pytest.raises(KeyboardInterrupt):
        world.step(*np.zeros((2, BATCH, 1)))
    np.testing.assert_array_equal(play(task, 2), expected)
    with pytest.raises(UserError, match="was killed"):
        world.reset(np.arange(BATCH))  # What was interrupted stays so.


def test_whatever_goes_wrong_in_a_process_is_told_to_whoever_asked(monkeypatch):
    monkeypatch.setattr("signal.signal", lambda *_: None)  # It would be this process' own.
    ours, theirs = Pipe()
    answers = []

    def ask():
        with ours:  # Its end ends `serve`.
            for _ in range(2):  # It still answers after an error.
                ours.send(("reset", (0, np.arange(2))))
                if ours.poll(30):
                    answers.append(ours.recv())

    def opener():
        raise KeyError("agent")

    asking = threading.Thread(target=ask)
    asking.start()
    serve(theirs, opener, "task", Sizes(1, 1, 1))
    asking.join(timeout=30)
    theirs.close()
    assert [rows for _, rows in answers] == [None, None]
    assert all(error.startswith("task: KeyError: 'agent' (") for error, _ in answers)


def test_processes_end_when_nobody_holds_the_task_any_more():
    task = make_task(f"{HERE}:two")
    task.make_world(BATCH, threads=2).reset(np.arange(BATCH))
    processes = [worker._process for worker in task._pool._workers]
    assert all(is_alive(process.pid) for process in processes)
    del task
    gc.collect()
    for process in processes:
        process.join(timeout=30)
        assert process.exitcode == 0


def test_processes_end_with_their_parent():
    code = (
        "import numpy as np, time\n"
        "from rigid.tasks.registry import make_task\n"
        f"task = make_task('{HERE}:two')\n"
        f"task.make_world({BATCH}, threads=2).reset(np.arange({BATCH}))\n"
        "print(*[w._process.pid for w in task._pool._workers], flush=True)\n"
        "time.sleep(60)\n"
    )
    parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    workers = [int(word) for word in parent.stdout.readline().split()]
    parent.kill()
    parent.wait(timeout=30)
    parent.stdout.close()
    assert len(workers) == 2
    for _ in range(300):
        if not any(map(is_alive, workers)):
            return
        time.sleep(0.1)
    pytest.fail("workers outlive their parent")
