"""Measuring the robots that `rigid compare --robots` names, all of them in one pool."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rigid.commands.parsing import parse_seeds
from rigid.commands.terminal.stopping import goes_on
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.commands.terminal.progress import TerminalListener
    from rigid.compute.listening import Workload


def measure_fleet(
    robots: Sequence[str],
    *,
    out: Path,
    task: str,
    human: str,
    preset: str,
    seeds: str | None,
    executor: str,
    return_range: str | None = None,
    trust: bool = False,
) -> list[Path]:
    """Measures robots into `out`, or goes on where an earlier call stopped.

    Args:
        robots: As `--robot` takes them.
        out: Each robot gets the folder of its name in it.
        task: Registered task.
        human: The synthetic human of all of them.
        preset: Name of the budget.
        seeds: Search seeds as people write them; None for the preset's.
        executor: Where groups run, as people write it.
        return_range: Range of adversarialness as people write it; None for the task's own.
        trust: Open robots whose files can run code.

    Returns:
        Their run directories, in the order of `robots`.

    Raises:
        UserError: Bad input; nothing was overwritten.
    """
    directories = [out / name for name in names_of(robots)]
    chosen = parse_seeds(seeds)
    from rigid.commands.terminal.progress import TerminalListener
    from rigid.compute.executors.executor import find_executor
    from rigid.compute.measurement import measure_robots
    from rigid.compute.preparation import settings_for
    from rigid.compute.return_range import find_return_range
    from rigid.compute.robot_run import Order
    from rigid.compute.subject import Subject
    from rigid.policies.opening import Opening
    from rigid.presets import find_preset
    from rigid.tasks.registry import make_task

    budget, world = find_preset(preset), make_task(task)
    where, range_ = find_executor(executor), find_return_range(return_range, world)
    orders = [
        Order(
            subject=Subject(
                world, robot, human, opening=Opening(trust=trust), return_range=range_
            ),
            preset=budget,
            settings=settings_for(budget), out=directory, seeds=chosen,
        )
        for robot, directory in zip(robots, directories, strict=True)
    ]  # fmt: skip
    with goes_on(out), TerminalListener(f"{len(robots)} robots · {budget.name}") as terminal:
        bar = FleetBar(terminal, sum(order.all_steps for order in orders if not _done(order.out)))
        told = [replace(o, listener=OneOfFleet(bar, o.out.name)) for o in orders]
        measure_robots(told, where)
    return directories


def names_of(robots: Sequence[str]) -> list[str]:
    """The folder of each robot: the last part of what it was called.

    Example:
        >>> names_of(["builtin:vanilla", "runs/robot-1/"])
        ['vanilla', 'robot-1']

    Raises:
        UserError: Two would share one.
    """
    names: dict[str, str] = {}
    for robot in robots:
        last = robot.removeprefix("builtin:").rstrip("/").rpartition("/")[2]
        name = re.sub(r"[^\w.+-]", "-", last).strip(".") or "robot"
        if name in names:
            raise UserError(
                f"--robots {names[name]!r} and {robot!r} would both be measured in the folder "
                f"{name!r}: rename one, or measure it with `rigid frontier` and compare directories"
            )
        names[name] = robot
    return list(names)


def _done(directory: Path) -> bool:
    return (directory / "frontier.json").exists()


class FleetBar:
    """The terminal's one bar for all robots of a fleet."""

    def __init__(self, terminal: TerminalListener, steps: int) -> None:
        self.terminal, self._expected, self._begun = terminal, steps, 0

    def begin(self, work: Workload) -> None:
        """One more robot is under way."""
        self._begun += work.steps
        # Robots that were complete but for new seeds are not expected.
        self.terminal.expect(max(self._expected, self._begun))
        self.terminal.resume(work)


class OneOfFleet:
    """Listens to the measurement of one robot."""

    def __init__(self, bar: FleetBar, name: str) -> None:
        self._bar, self._name = bar, name

    def begin(self, work: Workload) -> None:
        """Its time alone says nothing of the fleet's."""
        self.say(f"{work.training_steps:,} training steps")
        self._bar.begin(work)

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call."""
        self._bar.terminal.advance(env_steps)

    def say(self, text: str) -> None:
        """A line for the user."""
        self._bar.terminal.say(f"{self._name}: {text}")
