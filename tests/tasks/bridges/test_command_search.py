"""A whole search on a task that a program serves, against a robot that another one serves."""

from dataclasses import replace

import pytest

import rigid
from rigid.frontier.result import load_frontier
from rigid.policies.native import save_policy
from rigid.tasks.registry import make_task
from tests.compute.tiny import TINY
from tests.serving.programs import DOUBLER, REACH, children, write_program
from tests.toys import untrained


@pytest.mark.slow
def test_the_frontier_of_a_robot_in_a_program_on_a_task_in_a_program(tmp_path):
    before = children()
    task = make_task(f"exec:{write_program(tmp_path, REACH)}")
    save_policy(
        untrained(task.human), tmp_path / "human", agent="human", task=task.describe(),
        provenance={},
    )  # fmt: skip
    rigid.measure(
        task, f"exec:{write_program(tmp_path, DOUBLER, 'robot.py')}", human=str(tmp_path / "human"),
        preset=replace(TINY, per_round=(2,), iterations=2), seeds=[0], out=tmp_path / "run",
    )  # fmt: skip
    for session in task._sessions.get(list):
        session.close()
    frontier = load_frontier(tmp_path / "run")
    assert frontier.data["task"] == task.name
    assert [point["faults"] for point in frontier.points] == [0, 0]
    assert children() <= before
