"""What was acknowledged outlives the process, and readers never see half of anything."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from rigid.study.store import Store
from rigid.tasks.protocol import AgentSpec
from tests.study.toys import consented, toy_answer, toy_plan, toy_record

LINE = SimpleNamespace(
    horizon=10, feature_names=("hand", "goal"), outcome_names=("helped",),
    human=AgentSpec(3, 1), robot=AgentSpec(2, 1),
)  # fmt: skip
"""As much of a task as records take, without what imports JAX."""
ROOT = Path(__file__).parents[3]

SERVER = """
import sys
from pathlib import Path
from rigid.study.store import Store
from tests.study.store.test_durability import LINE
from tests.study.toys import consented, toy_answer, toy_plan, toy_record

store = Store.open(Path(sys.argv[1]), toy_plan())
code, task = consented(store), LINE
for number in range(10_000):
    store.begin_attempt(code, "play", number)
    store.add_episode(toy_record(task, code, number), 2)
    print("episode", number, flush=True)
    store.add_answer(toy_answer(code, f"t{number:02}"))
    print("answer", number, flush=True)
"""


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    """A study whose server was killed while it stored; and the last that it acknowledged."""
    data = tmp_path_factory.mktemp("killed") / "data"
    server = subprocess.Popen(
        [sys.executable, "-c", SERVER, str(data)], stdout=subprocess.PIPE, text=True, cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert server.stdout is not None
    said = [server.stdout.readline().split() for _ in range(31)]
    server.send_signal(signal.SIGKILL)
    said += [line.split() for line in server.stdout.read().splitlines()]
    server.stdout.close()
    assert server.wait(timeout=60) == -signal.SIGKILL
    return data, [words for words in said if len(words) == 2]


def test_a_killed_server_loses_nothing_that_it_acknowledged(killed):
    data, said = killed
    with Store.open(data, toy_plan()) as store:
        episodes = [record.number for record in store.episodes("P01")]
        answers = [int(answer.trial[1:]) for answer in store.answers("P01")]
    assert len(said) >= 31
    assert {int(number) for what, number in said if what == "episode"} <= set(episodes)
    assert {int(number) for what, number in said if what == "answer"} <= set(answers)
    assert episodes == list(range(len(episodes)))


def test_a_killed_server_leaves_no_lock_and_no_damage(killed):
    data, _ = killed
    with Store.open(data) as store:
        assert store._db.execute("PRAGMA integrity_check").fetchone()[0] == "ok"
        expected = toy_record(LINE, "P01", 3)
        found = next(record for record in store.episodes("P01") if record.number == 3)
        assert found.arrays.to_bytes() == expected.arrays.to_bytes()
        assert store.begin_attempt("P01", "play", 3) == 2


def test_every_commit_of_an_episode_or_answer_waits_for_the_disk(tmp_path):
    with Store.open(tmp_path, toy_plan()) as store:
        code = consented(store)
        modes = []
        store._db.set_trace_callback(modes.append)
        store.add_episode(toy_record(LINE, code), 2)
        store.count_refused("rate")
        store.add_answer(toy_answer(code))
        store._db.set_trace_callback(None)
        assert store._db.execute("PRAGMA journal_mode").fetchone()[0] == "wal"
    chosen = [mode for mode in modes if mode.startswith("PRAGMA synchronous")]
    assert chosen == [f"PRAGMA synchronous={mode}" for mode in ("FULL", "NORMAL", "FULL")]


def test_readers_in_other_processes_see_whole_trials_while_one_writes(tmp_path):
    reader = """
import sys
from pathlib import Path
from rigid.study.store import Store
with Store.read(Path(sys.argv[1])) as store:
    print("ready", flush=True)
    while True:
        answers = store.answers()
        assert len(answers) % 2 == 0, "half a trial"
        if len(answers) == 80:
            break
print("whole")
"""
    with Store.open(tmp_path, toy_plan()) as store:
        code = consented(store)
        process = subprocess.Popen(
            [sys.executable, "-c", reader, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        for number in range(40):
            trial = f"t{number:02}"
            store.add_answers([toy_answer(code, trial, of=of) for of in ("first", "second")])
        assert process.communicate(timeout=120)[0] == "whole\n"
    assert process.returncode == 0
