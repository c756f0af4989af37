"""Training robots and measuring them one seed at a time; all of it is kept on disk."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import rigid
from benchmarks.robots import OWN_HUMAN, TASK, make_robot, refuse_other
from benchmarks.standard.plan import Plan, Robot
from rigid.commands.progress import TerminalListener
from rigid.compute.group import GroupPlan
from rigid.compute.run_directory import RunDirectory, read_settings
from rigid.frontier.result import FILE, Frontier, load_frontier
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.native import CARD_FILE
from rigid.tasks.registry import make_task

_OF_A_PRESET = ("preset", "adversary")
"""Entries of a run's identity in which both presets may differ."""


class Part(NamedTuple):
    """One seed of one robot with one preset."""

    robot: Robot
    preset: str
    seed: int

    @property
    def name(self) -> str:
        """Said while it is measured."""
        return f"{self.robot.name}, {self.preset}, seed {self.seed}"


class Workplace:
    """The directory of raw runs: ROBOT/robot, a run directory ROBOT/PRESET each, own-pair."""

    def __init__(self, plan: Plan, out: Path) -> None:
        self.plan, self.out = plan, out
        self.task = make_task(TASK)

    def policy(self, robot: Robot) -> Path:
        """Where a robot is that the study trains."""
        return self.out / robot.name / "robot"

    def run_directory(self, robot: Robot, preset: str) -> Path:
        """Where a robot's measurement is."""
        return self.out / robot.name / preset

    def parts(self, seed: int) -> list[Part]:
        """Everything that is measured with one seed."""
        return [
            Part(robot, preset, seed)
            for robot in self.plan.robots
            for preset in self.plan.presets()
        ]

    def missing(self, seed: int) -> list[Part]:
        """What is yet to be measured with one seed."""
        return [part for part in self.parts(seed) if seed not in self._seeds(part)]

    def is_searched(self, part: Part) -> bool:
        """Whether the search of a missing part is over: only its measurement is not summed up."""
        last = GroupPlan(part.seed, len(self.plan.presets()[part.preset].per_round), ())
        groups = self.run_directory(part.robot, part.preset) / "groups"
        return (groups / f"{last.name}.json").exists()

    def untrained(self) -> list[Robot]:
        """Robots that are yet to be trained."""
        return [
            robot for robot in self.plan.robots
            if robot.training is not None and not (self.policy(robot) / CARD_FILE).exists()
        ]  # fmt: skip

    def make_robots(self) -> None:
        """Trains the robots; finished ones are only checked."""
        for robot in self.plan.robots:
            if robot.training is not None:
                make_robot(
                    robot.training, self.plan.recipe, task=self.task, out=self.policy(robot),
                    pair=self.out / "own-pair",
                    canonical_episodes=self.plan.standard.search_canonical,
                )  # fmt: skip

    def measure(self, part: Part) -> None:
        """Adds a seed to a measurement; one that was begun there is finished with it."""
        preset = self.plan.presets()[part.preset]
        place = self.run_directory(part.robot, part.preset)
        before = len(self._seeds(part)) * preset.env_steps(self.task.horizon) // len(preset.seeds)
        with TerminalListener(part.name) as terminal:
            rigid.measure(
                self.task, self._spec(part.robot), out=place, preset=preset, seeds=(part.seed,),
                human=OWN_HUMAN, listener=_OneSeed(terminal, before),
            )  # fmt: skip

    def frontiers(self, robot: Robot) -> dict[str, Frontier]:
        """The complete measurements of a robot, by preset."""
        places = {name: self.run_directory(robot, name) for name in self.plan.presets()}
        return {
            name: load_frontier(place) for name, place in places.items() if (place / FILE).exists()
        }

    def check_runs(self) -> None:
        """Refuses measurements of another plan, and pairs that differ in more than their preset.

        Raises:
            UserError: The message names the first difference.
        """
        human = policy_hash(load_policy(OWN_HUMAN, task=self.task, agent="human"))
        for robot in self.plan.robots:
            stored = {}
            for name, preset in self.plan.presets().items():
                run = RunDirectory(self.run_directory(robot, name))
                if not run.settings.exists():
                    continue
                stored[name] = read_settings(run)["identity"]
                budget = {key: value for key, value in preset.describe().items() if key != "seeds"}
                asked = {
                    "preset": budget, "robot": self._robot_hash(robot), "human": human,
                    "task": dict(self.task.describe()),
                }  # fmt: skip
                refuse_other(run.path, asked, stored[name])
            shared = [
                {key: value for key, value in identity.items() if key not in _OF_A_PRESET}
                for identity in stored.values()
            ]
            if len(shared) == 2:
                refuse_other(self.run_directory(robot, "paper"), *shared)

    def _robot_hash(self, robot: Robot) -> str:
        return policy_hash(load_policy(self._spec(robot), task=self.task, agent="robot"))

    def _spec(self, robot: Robot) -> str:
        return f"builtin:{robot.name}" if robot.training is None else str(self.policy(robot))

    def _seeds(self, part: Part) -> set[int]:
        """Seeds that a complete measurement has: it is complete for all in its settings or none."""
        run = RunDirectory(self.run_directory(part.robot, part.preset))
        return set(read_settings(run)["seeds"]) if run.frontier.exists() else set()


class _OneSeed:
    """A bar of what is new: steps of the seeds before it, which are only read, do not show."""

    def __init__(self, terminal: TerminalListener, before: int) -> None:
        self._terminal, self._before = terminal, before

    def begin(self, env_steps: int, seconds: float) -> None:
        """Training starts."""
        new = env_steps - self._before
        self._terminal.begin(new, seconds * new / env_steps)

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call."""
        old = min(self._before, env_steps)
        self._before -= old
        self._terminal.advance(env_steps - old)

    def say(self, text: str) -> None:
        """A line for the user."""
        self._terminal.say(text)
