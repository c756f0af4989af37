"""Frontiers of all robots, measured once and kept."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import rigid
from benchmarks.kept import keep_run, kept_run
from benchmarks.paper.making import SCOUT, Making
from benchmarks.paper.places import Places
from benchmarks.paper.plan import Plan
from rigid.commands.terminal.progress import TerminalListener
from rigid.data.episodes import save_episodes
from rigid.data.recording import record
from rigid.frontier.result import Frontier, load_frontier
from rigid.policies.loading import load_policy
from rigid.presets import Preset
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task

THOROUGH = "-paper"
"""Ends the name of a frontier with the paper's own budget."""


class Measuring:
    """Measures what is missing."""

    def __init__(self, plan: Plan, places: Places, task: Task) -> None:
        self._plan, self._places, self._task = plan, places, task
        self.making = Making(plan, places, task, self.scout)

    def has(self, name: str, seed: int) -> bool:
        """Whether a frontier is kept."""
        return kept_run(self._places.kept_run(name, seed)) is not None

    def frontier(self, name: str, seed: int) -> Frontier | None:
        """A frontier that is kept, None where there is none yet."""
        return kept_run(self._places.kept_run(name, seed))

    def robot(self, name: str, seed: int) -> Path:
        """Measures a robot with the plan's preset; returns the run directory."""
        return self._measure(name, seed, robot=name, preset=self._plan.preset)

    def thoroughly(self, name: str, seed: int, preset: Preset) -> Path:
        """Measures a robot with the paper's own budget."""
        return self._measure(f"{name}{THOROUGH}", seed, robot=name, preset=preset)

    def scout(self, seed: int) -> Path:
        """Measures `vanilla` with search seeds of which no robot is judged; not kept."""
        robot = self.making.robot("vanilla", seed)
        return self._search(robot, seed, self._places.run(SCOUT, seed), self._plan.scouting)

    def body(self, label: str, changes: Mapping[str, Any]) -> Path:
        """Measures the first `vanilla` robot with another person in the chair."""
        seed, name = self._plan.first, body_run(label)
        task = make_task(self._task.name, **changes)
        robot = self.making.robot("vanilla", seed)
        canonical = self._places.run(name, seed).with_suffix(".npz")
        self._record(task, robot, seed, canonical)
        run = self._search(
            robot, seed, self._places.run(name, seed), self._plan.preset,
            task=task, canonical=canonical,
        )  # fmt: skip
        keep_run(run, self._places.kept_run(name, seed))
        return run

    def _measure(self, name: str, seed: int, *, robot: str, preset: Preset) -> Path:
        directory = self.making.robot(robot, seed)
        run = self._search(directory, seed, self._places.run(name, seed), preset)
        keep_run(run, self._places.kept_run(name, seed))
        return run

    def _search(
        self,
        robot: Path,
        seed: int,
        out: Path,
        preset: Preset,
        *,
        task: Task | None = None,
        canonical: Path | None = None,
    ) -> Path:
        human = str(self.making.pair(seed) / "human")
        with TerminalListener(f"{out.name}, robot seed {seed}") as listener:
            rigid.measure(
                task or self._task, str(robot), human=human, out=out, preset=preset,
                canonical=canonical, listener=listener,
            )  # fmt: skip
        load_frontier(out).report()
        return out

    def _record(self, task: Task, robot: Path, seed: int, path: Path) -> None:
        """Canonical episodes of another person, which those beside the robot do not show."""
        human = str(self.making.pair(seed) / "human")
        episodes = record(
            task,
            load_policy(str(robot), task=task, agent="robot"),
            load_policy(human, task=task, agent="human"),
            episodes=self._plan.canonical_episodes, seed=seed, provenance={},
        )  # fmt: skip
        path.parent.mkdir(parents=True, exist_ok=True)
        save_episodes(path, episodes)


def body_run(label: str) -> str:
    """The name of the frontier with another person.

    Example:
        >>> body_run("5th percentile")
        'body-5th-percentile'
    """
    return f"body-{label.replace(' ', '-')}"
