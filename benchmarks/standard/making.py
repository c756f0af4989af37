"""Where the parts of the study lie, and how they are made: raw in OUT, finished ones in RESULTS."""

from __future__ import annotations

import re
from pathlib import Path

from benchmarks.kept import has_policy, keep_policy, keep_run, kept_run
from benchmarks.robots import OWN_HUMAN, TASK, check_made, make_robot
from benchmarks.standard.plan import Part, Plan, Robot
from rigid.compute.listening import Listener
from rigid.compute.preparation import settings_for
from rigid.compute.robot_run import Order
from rigid.compute.search.group_plan import GroupPlan
from rigid.compute.subject import CANONICAL_FILE, Subject
from rigid.frontier.result import FILE, Frontier
from rigid.tasks.registry import make_task

_SEED = re.compile(r"seed-(\d+)")


class Workplace:
    """The directories of the study.

    OUT holds ROBOT/PRESET/seed-S, a raw run each, ROBOT/robot, a robot in training, and own-pair;
    RESULTS holds robots/ROBOT and runs/ROBOT/PRESET/seed-S, kept as soon as they are finished.
    Whatever is kept is done, on whichever machine it was made.
    """

    def __init__(self, plan: Plan, out: Path, results: Path) -> None:
        self.plan, self.out, self.results = plan, out, results
        self.task = make_task(TASK)

    def raw(self, part: Part) -> Path:
        """Where a part is measured."""
        return self.out / part.place

    def kept(self, part: Part) -> Path:
        """Where a part is kept once it is finished."""
        return self.results / "runs" / part.place

    def policy(self, robot: Robot) -> Path:
        """Where a robot is kept that the study trained."""
        return self.results / "robots" / robot.name

    def spec(self, robot: Robot) -> str:
        """A robot as `--robot` takes it."""
        return f"builtin:{robot.name}" if robot.training is None else str(self.policy(robot))

    def is_kept(self, part: Part) -> bool:
        """Whether a part is done."""
        return (self.kept(part) / FILE).exists()

    def missing(self) -> list[Part]:
        """What is yet to be measured, in this order."""
        return [part for part in self.plan.parts() if not self.is_kept(part)]

    def kept_parts(self) -> list[Part]:
        """What is done, other seeds than the plan's included."""
        every = self.plan.with_seeds(self.seeds()).parts()
        return [part for part in every if self.is_kept(part)]

    def seeds(self) -> list[int]:
        """Search seeds of the plan, and others that are kept."""
        folders = [
            folder for robot in self.plan.robots for preset in self.plan.presets()
            for folder in (self.results / "runs" / robot.name / preset).glob("seed-*")
        ]  # fmt: skip
        kept = [found[1] for folder in folders if (found := _SEED.fullmatch(folder.name))]
        return sorted({*self.plan.seeds, *map(int, kept)})

    def searched_share(self, part: Part) -> float:
        """How much of a missing part's search is done, in [0, 1]."""
        if (self.raw(part) / FILE).exists():
            return 1.0
        rounds = len(self.plan.search(part.preset).per_round)
        groups = self.raw(part) / "groups"
        names = [GroupPlan(part.seed, number + 1, ()).name for number in range(rounds)]
        return sum((groups / f"{name}.json").exists() for name in names) / rounds

    def untrained(self) -> list[Robot]:
        """Robots that are yet to be trained."""
        return [
            robot for robot in self.plan.robots
            if robot.training is not None and not has_policy(self.policy(robot))
            and not has_policy(self._training(robot))
        ]  # fmt: skip

    def make_robots(self) -> None:
        """Trains the robots and keeps them; those that are kept are only checked.

        Raises:
            UserError: One was made otherwise than the plan says.
        """
        for robot in self.plan.robots:
            plan, kept = robot.training, self.policy(robot)
            if plan is None:
                continue
            if has_policy(kept):
                check_made(kept, self.task, plan.settings(self.plan.recipe), plan.seed)
                continue
            make_robot(
                plan, self.plan.recipe, task=self.task, out=self._training(robot),
                pair=self.out / "own-pair",
                canonical_episodes=self.plan.standard.search_canonical,
            )  # fmt: skip
            keep_policy(self._training(robot), kept, beside=(CANONICAL_FILE,))

    def order(self, part: Part, listener: Listener) -> Order:
        """How a part is measured, or gone on with."""
        preset = self.plan.presets()[part.preset]
        return Order(
            subject=Subject(self.task, self.spec(part.robot), OWN_HUMAN), preset=preset,
            settings=settings_for(preset), out=self.raw(part), seeds=(part.seed,),
            listener=listener,
        )  # fmt: skip

    def keep(self, part: Part) -> None:
        """Keeps a part that is finished."""
        keep_run(self.raw(part), self.kept(part))

    def keep_finished(self) -> None:
        """Keeps what an earlier call finished and could not keep any more."""
        for part in self.missing():
            if (self.raw(part) / FILE).exists():
                self.keep(part)

    def frontiers(self, robot: Robot) -> dict[str, dict[int, Frontier]]:
        """The measurements of a robot that are done, by preset and search seed.

        Raises:
            UserError: One is damaged.
        """
        return {
            preset: {
                seed: frontier for seed in self.seeds()
                if (frontier := kept_run(self.kept(Part(robot, preset, seed)))) is not None
            }
            for preset in self.plan.presets()
        }  # fmt: skip

    def _training(self, robot: Robot) -> Path:
        return self.out / robot.name / "robot"
