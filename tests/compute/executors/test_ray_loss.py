"""A node of the cluster dies in mid-run: its group is done again elsewhere, and nothing else is."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import NamedTuple

import pytest

from rigid.compute.executors.executor import Local
from rigid.compute.executors.ray_executor import RayExecutor
from rigid.frontier.result import Frontier
from tests.compute.executors.ray_cluster import RayCluster
from tests.compute.executors.ray_tasks import Doomed
from tests.compute.tiny import Notes, measure_tiny, measured_once, without_times

pytestmark = pytest.mark.slow  # Two nodes start and work: nearly a minute.

SHORT = {"seeds": (0, 1, 2, 3), "lambdas": (0.1,)}
"""One group for each of four seeds: one ends on each node, and each node is in its second one."""


class Telling(Notes):
    """Notes what is told of nodes, and lets those go on that wait for it."""

    def __init__(self, task: Doomed) -> None:
        super().__init__()
        self._task = task

    def say(self, text):
        super().say(text)
        if "on 1 node" in text:
            self._task.told.touch()


class Bereaved(NamedTuple):
    """A measurement whose cluster lost a node."""

    frontier: Frontier
    task: Doomed
    notes: Notes
    done_before: dict[Path, int]
    """Files of the groups that were done when the node died, with their times."""


@pytest.fixture(scope="module")
def bereaved(base, tmp_path_factory):
    out, task = tmp_path_factory.mktemp("ray") / "run", Doomed(tmp_path_factory.mktemp("desk"))
    cluster, notes, done_before = RayCluster(), Telling(task), {}
    over = threading.Event()

    def kill():
        """Once the node is in its second group, and others are done."""
        while not over.wait(0.05):
            done = list((out / "groups").glob("s*.json"))
            done = [path for path in done if path.name != "spent.json"]
            if task.held.exists() and len(done) >= 2:
                done_before.update((path, path.stat().st_mtime_ns) for path in done)
                cluster.kill_node("doomed")
                return

    killer = threading.Thread(target=kill)
    try:
        cluster.add_node("doomed")
        killer.start()
        executor = RayExecutor(cluster.address)
        frontier = measure_tiny(base, out, task=task, executor=executor, listener=notes, **SHORT)
        yield Bereaved(frontier, task, notes, done_before)
    finally:
        over.set()
        killer.join()
        cluster.stop()


def test_a_run_that_lost_a_node_ends_with_the_same_numbers(base, bereaved):
    alone = measured_once(base, "short", executor=Local(), **SHORT)
    assert without_times(bereaved.frontier) == without_times(alone)


def test_groups_that_were_done_when_a_node_died_are_not_done_again(bereaved):
    assert len(bereaved.done_before) >= 2
    after = {path: path.stat().st_mtime_ns for path in bereaved.done_before}
    assert after == bereaved.done_before


def test_only_the_group_that_died_with_its_node_is_begun_anew(bereaved):
    assert bereaved.task.groups("doomed") == 2
    assert bereaved.task.groups() == len(SHORT["seeds"]) + 1


def test_the_user_is_told_that_a_node_went(bereaved):
    said = [text for text in bereaved.notes.lines if text.startswith("Ray: ")]
    assert said == [
        "Ray: 2 workers on 2 nodes, 1 CPU for each", "Ray: 1 worker on 1 node, 1 CPU for each",
    ]  # fmt: skip
