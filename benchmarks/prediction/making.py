"""Training, measuring and playing: the parts that take long, each kept once it is finished."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import rigid
from benchmarks.prediction.plan import HumanPlan, Plan
from benchmarks.robots import OWN_HUMAN, TASK, RobotPlan, check_made, make_robot, refuse_other
from benchmarks.study import once, say
from rigid.commands.terminal.progress import TerminalListener
from rigid.commands.train.progress import show_progress
from rigid.compute.evaluation import evaluate
from rigid.errors import UserError
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.native import CARD_FILE
from rigid.robots.pair import train_pair
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task


class Workplace:
    """The directory of raw runs: `pairs/`, `robots/`, `frontiers/`, `meetings/`."""

    def __init__(self, plan: Plan, out: Path) -> None:
        self.plan, self.out = plan, out
        self.task = make_task(TASK)
        self._worlds: dict[str, Task] = {}

    def pair(self, seed: int) -> Path:
        """Where a co-optimised pair is."""
        return self.out / "pairs" / str(seed)

    def robot(self, robot: RobotPlan) -> Path:
        """Where a robot is."""
        return self.out / "robots" / robot.name

    def frontier(self, robot: RobotPlan) -> Path:
        """Where a robot's measurement is."""
        return self.out / "frontiers" / robot.name

    def meeting(self, robot: RobotPlan, human: HumanPlan) -> Path:
        """Where it stands how a robot did with an unseen human."""
        return self.out / "meetings" / robot.name / f"{human.name}.json"

    def make_pair(self, seed: int) -> None:
        """Trains a pair, or goes on with it; a finished one is only checked."""
        place, settings = self.pair(seed), self.plan.pair_settings
        if (place / "human" / CARD_FILE).exists():
            check_made(place / "human", self.task, settings, seed)
            return
        with show_progress(f"pair of seed {seed}", settings.iterations) as report:
            train_pair(self.task, settings, seed=seed, out=place, report=report)

    def make_robot(self, robot: RobotPlan) -> None:
        """Trains a robot for the own human, or goes on with it; a finished one is only checked."""
        make_robot(
            robot, self.plan.training, task=self.task, out=self.robot(robot),
            pair=self.out / "pairs" / "own",
            canonical_episodes=self.plan.preset.search_canonical,
        )  # fmt: skip

    def measure(self, robot: RobotPlan) -> Mapping[str, Any]:
        """The robot's `frontier.json`; searched first, or gone on with, where it is not there."""
        with TerminalListener(f"frontier of {robot.name}") as listener:
            found = rigid.measure(
                self.task, str(self.robot(robot)), out=self.frontier(robot),
                preset=self.plan.preset, human=OWN_HUMAN, listener=listener,
            )  # fmt: skip
        return found.data

    def meet(self, robot: RobotPlan, human: HumanPlan) -> dict[str, Any]:
        """How a robot does with an unseen human: what `evaluate` says, and of whom.

        Raises:
            UserError: What is kept there is of another robot, human, task or budget.
        """
        # Compiling a scene and finding its clear starts takes as long as a hundred episodes.
        task = self._worlds.setdefault(human.name, make_task(TASK, **human.changes))
        spec = OWN_HUMAN if human.pair is None else str(self.pair(human.pair) / "human")
        assistant = load_policy(str(self.robot(robot)), task=task, agent="robot")
        person = load_policy(spec, task=task, agent="human")
        identity = {
            "robot": policy_hash(self.robot(robot)), "human": policy_hash(person),
            "task": dict(task.describe()), "episodes": self.plan.episodes, "seed": human.seed,
        }  # fmt: skip

        def play() -> dict[str, Any]:
            say(f"{robot.name} meets {human.name}")
            measured = evaluate(
                task, assistant, person, episodes=self.plan.episodes, seed=human.seed
            )
            return {"identity": identity, **measured}

        place = self.meeting(robot, human)
        kept: dict[str, Any] = once(place, play)
        refuse_other(place, identity, kept["identity"])
        if kept["adversarialness"] is None:
            raise UserError(f"{place}: in every episode the physics ran away, so nothing is known")
        return kept
