"""Groups on a Ray cluster of two nodes: the same numbers, and nothing lost by an interrupt."""

from __future__ import annotations

import sys
import time
import types
from pathlib import Path

import pytest
import ray

import rigid.compute.executors.ray_executor as subject
from rigid.cli import run
from rigid.compute.executors.executor import Local
from rigid.compute.executors.ray_executor import RayExecutor
from rigid.errors import UserError
from rigid.policies.native import save_policy
from rigid.presets import PRESETS
from tests.compute.executors.ray_cluster import RayCluster
from tests.compute.executors.ray_tasks import Deadly, Stuck
from tests.compute.tiny import (
    TINY,
    FilmedReach,
    Notes,
    hasten_referees,
    interrupt_at,
    measure_tiny,
    measured_once,
    start_rigid,
    without_times,
)
from tests.toys import untrained

pytestmark = pytest.mark.slow  # Two nodes start and work: nearly a minute.

PATIENCE = 120.0
"""Seconds until something counts as hung; a shared machine may be slow."""
ELSEWHERE = """
from tests.compute.executors.ray_tasks import Watched

class Elsewhere(Watched):
    pass
"""


@pytest.fixture(scope="module")
def address():
    """A cluster of two nodes with a CPU each, which this process has joined."""
    cluster = RayCluster()
    try:
        cluster.add_node("second")
        with cluster.joined() as address:
            yield address
    finally:
        cluster.stop()


def files_of(directory):
    return {path.relative_to(directory) for path in directory.rglob("*") if path.name != ".lock"}


@pytest.fixture(scope="module")
def task(tmp_path_factory):
    """Its module lies where only this process looks for modules."""
    place = tmp_path_factory.mktemp("modules")
    (place / "toy_elsewhere.py").write_text(ELSEWHERE)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(place)
        yield __import__("toy_elsewhere").Elsewhere(tmp_path_factory.mktemp("desk"))


@pytest.fixture(scope="module")
def interrupted(base, task, address, tmp_path_factory):
    """A measurement that was begun here, went on in the cluster, and stopped after a group."""
    out = tmp_path_factory.mktemp("ray") / "run"
    checkpoint = out / "groups" / "s0-r1.safetensors"
    with pytest.raises(KeyboardInterrupt):
        measure_tiny(base, out, executor=Local(), listener=Notes(stop=checkpoint.exists))
    done = Notes(stop=lambda: any((out / "groups").glob("*-r1.json")))
    with pytest.raises(KeyboardInterrupt):
        measure_tiny(base, out, task=task, executor=f"ray:{address}", listener=done)
    return out, {path: path.stat().st_mtime_ns for path in (out / "groups").glob("*.json")}


@pytest.fixture(scope="module")
def resumed(base, task, address, interrupted):
    """The same measurement, gone on with in the cluster; and what it said."""
    notes = Notes()
    executor = f"ray:{address}"
    out, _ = interrupted
    return measure_tiny(base, out, task=task, executor=executor, listener=notes), notes


def test_a_cluster_leaves_the_numbers_and_files_of_a_single_process(base, resumed):
    frontier, _ = resumed
    alone = measured_once(base, "alone", executor=Local())
    assert without_times(frontier) == without_times(alone)
    assert files_of(frontier.directory) | {Path("report.html")} == files_of(alone.directory)


def test_learning_curves_have_neither_gaps_nor_repeats(base, resumed):
    frontier, _ = resumed
    alone = measured_once(base, "alone", executor=Local())
    for path in alone.directory.rglob("metrics.jsonl"):
        place = path.relative_to(alone.directory)
        assert (frontier.directory / place).read_bytes() == path.read_bytes()


def test_groups_that_were_done_before_an_interrupt_are_not_done_again(resumed, interrupted):
    del resumed
    _, done = interrupted
    assert any(path.name.endswith("-r1.json") for path in done)
    kept = {path: path.stat().st_mtime_ns for path in done if path.name != "spent.json"}
    assert kept == {path: done[path] for path in kept}


def test_workers_look_for_modules_where_the_driver_finds_them(task, resumed):
    del resumed
    assert task.groups() >= 4


def test_workers_and_nodes_are_told_and_every_step(resumed):
    frontier, notes = resumed
    assert "Ray: 2 workers on 2 nodes, 1 CPU for each" in notes.lines
    assert notes.work.done > 0  # Before it was interrupted.
    assert notes.complete
    assert frontier.data["core_seconds"] > 0


def test_an_interrupt_takes_back_what_is_not_done(base, address, tmp_path):
    task = Stuck(tmp_path)
    out, executor = tmp_path / "run", RayExecutor(address)
    with interrupt_at(out, lambda: task.groups() == 2), pytest.raises(KeyboardInterrupt):
        measure_tiny(base, out, task=task, executor=executor)
    give_up = time.monotonic() + PATIENCE
    while ray.available_resources().get("CPU") != 2:
        assert time.monotonic() < give_up, "groups that never end still hold CPUs"
        time.sleep(0.1)


def test_a_group_that_kills_every_worker_comes_to_an_end(base, address, tmp_path, monkeypatch):
    monkeypatch.setattr(subject, "MAX_RETRIES", 1)
    task, out = Deadly(tmp_path), tmp_path / "run"
    with pytest.raises(UserError) as caught:
        measure_tiny(base, out, task=task, executor=RayExecutor(address), seeds=[0])
    assert str(caught.value).startswith(f"group s0-r1 of {out} lost its workers (")
    cure = "): see that they have memory enough; the same command goes on"
    assert str(caught.value).endswith(cure)
    assert task.groups() == 2


def test_a_damaged_checkpoint_is_named_where_the_user_finds_it(base, address, tmp_path):
    checkpoint = tmp_path / "run" / "groups" / "s0-r1.safetensors"
    with pytest.raises(KeyboardInterrupt):
        measure_tiny(
            base, tmp_path / "run", executor=Local(), listener=Notes(stop=checkpoint.exists)
        )
    checkpoint.write_bytes(checkpoint.read_bytes()[:1000])
    with pytest.raises(UserError) as caught:
        measure_tiny(base, tmp_path / "run", executor=RayExecutor(address))
    assert str(caught.value).startswith(f"{checkpoint} is damaged ")
    assert str(caught.value).endswith(": delete this file to train from the start of its group")


def test_a_task_that_holds_what_cannot_be_sent_is_refused(base, address, tmp_path):
    task = FilmedReach()
    with (tmp_path / "open").open("w") as task.file, pytest.raises(UserError) as caught:
        measure_tiny(base, tmp_path / "run", task=task, executor=RayExecutor(address))
    start = "task 'toy-reach' and its robot cannot be sent to other machines ("
    assert str(caught.value).startswith(start)
    assert str(caught.value).endswith("): use the executor local")


def test_a_worker_without_the_tasks_package_says_what_to_install(
    base, address, tmp_path, monkeypatch
):
    class OnlyHere(FilmedReach):
        pass

    OnlyHere.__module__, OnlyHere.__qualname__ = "only_here", "OnlyHere"
    module = types.ModuleType("only_here")
    module.OnlyHere = OnlyHere
    monkeypatch.setitem(sys.modules, "only_here", module)
    with pytest.raises(UserError) as caught:
        measure_tiny(base, tmp_path / "run", task=OnlyHere(), executor=RayExecutor(address))
    assert str(caught.value).startswith("the worker on ")
    assert str(caught.value).endswith(
        " cannot load the task and its robot (No module named 'only_here'): install there what "
        "this machine has, the package of the task as well"
    )


@pytest.mark.slow
def test_a_cluster_that_asks_for_another_token_is_named_with_the_cure(
    base, site, address, tmp_path, monkeypatch
):
    """In a process of its own: Ray reads the token once."""
    monkeypatch.setenv("RAY_AUTH_TOKEN", "0" * 64)
    pair = base / "pair"
    process = start_rigid(
        site, "frontier", "--task", "toy-reach", "--robot", str(pair / "robot"),
        "--human", str(pair / "human"), "--preset", "tiny", "--out", str(tmp_path / "run"),
        "--executor", f"ray:{address}",
    )  # fmt: skip
    _, err = process.communicate(timeout=5 * PATIENCE)
    assert process.returncode == 2
    assert f"rigid: cannot join the Ray cluster at {address} (" in err
    assert "with its RAY_AUTH_MODE where it asks for a token" in err
    assert "Traceback" not in err


@pytest.fixture
def fleet(base, site, address, tmp_path, monkeypatch, capsys):
    """Runs `rigid compare` on two toy robots in the cluster: code, output, and what it said."""
    monkeypatch.syspath_prepend(site)
    monkeypatch.setitem(PRESETS, "tiny", TINY)
    hasten_referees(monkeypatch)
    task, other = FilmedReach(), base / "pair" / "other"
    save_policy(
        untrained(task.robot, seed=2), other, agent="robot", task=task.describe(), provenance={}
    )

    def command():
        code = run([
            "compare", "--robots", str(base / "pair" / "robot"), str(other),
            "--human", str(base / "pair" / "human"), "--task", "toy-reach", "--preset", "tiny",
            "--seeds", "0", "--executor", f"ray:{address}", "--out", str(tmp_path / "fleet"),
        ])  # fmt: skip
        return code, *capsys.readouterr()

    return command


def test_a_fleet_is_measured_in_one_pool_then_compared(fleet, tmp_path):
    code, out, err = fleet()
    assert code == 0
    assert "minus robot, on the search seeds that both have" in out
    assert err.count("Ray: 2 workers on 2 nodes, 1 CPU for each") == 1
    assert {path.parent.name for path in tmp_path.glob("fleet/*/frontier.json")} == {
        "robot", "other",
    }  # fmt: skip
    again = fleet()
    assert again[:2] == (0, out)
    assert again[2].count("is already complete; nothing to do") == 2
