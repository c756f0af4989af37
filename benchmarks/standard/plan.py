"""What is measured with both presets, and by how much one may fall short of the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from benchmarks.robots import QUICK_RECIPE, RECIPE, RobotPlan
from benchmarks.short_search import QUICK_PRESET
from rigid.learning.conditioned import Sharing
from rigid.learning.personalisation import PersonalisationSettings
from rigid.presets import PRESETS, Preset

DECIDING = ("auc", "auc_natural")
"""Numbers that must keep the limit; all others are information."""
LIMIT = 0.02
"""By how much `standard` may find less than `paper`, in shares of the range of y: the lower end of
the paired difference's 95 % interval is held against it. Fixed before the first measurement; ours.
"""
CURVE_SEEDS = len(PRESETS["standard"].seeds)
"""Search seeds of the curve that costs are given for."""


@dataclass(frozen=True)
class Robot:
    """A robot that is measured with both presets."""

    name: str
    training: RobotPlan | None = None
    """How the study trains it; None: the bundled robot of that name."""


class Part(NamedTuple):
    """One search seed of one robot with one preset: a measurement of its own."""

    robot: Robot
    preset: str
    seed: int

    @property
    def name(self) -> str:
        """Said when it is measured."""
        return f"{self.robot.name}, {self.preset}, seed {self.seed}"

    @property
    def place(self) -> Path:
        """Of its run directory, below that of all runs.

        Example:
            >>> Part(Robot("vanilla"), "paper", 3).place.as_posix()
            'vanilla/paper/seed-3'
        """
        return Path(self.robot.name, self.preset, f"seed-{self.seed}")

    @property
    def other(self) -> Part:
        """The one that it makes a pair with."""
        return self._replace(preset="paper" if self.preset == "standard" else "standard")


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The study."""

    robots: tuple[Robot, ...]
    standard: Preset
    paper: Preset
    seeds: tuple[int, ...]
    """Search seeds, in the order in which they are measured; those of the presets do not count."""
    recipe: PersonalisationSettings
    """Of every robot that is trained, but for its length."""
    command: str
    stamp: str = ""
    """Printed on the account."""

    def presets(self) -> dict[str, Preset]:
        """Both presets by the names of their directories, the cheap one first."""
        return {"standard": self.standard, "paper": self.paper}

    def search(self, preset: str) -> Preset:
        """The budget of one part."""
        return replace(self.presets()[preset], seeds=(0,))

    def parts(self) -> list[Part]:
        """Everything that is measured: each seed of every robot and preset, then the next seed."""
        return [
            Part(robot, preset, seed)
            for seed in self.seeds for robot in self.robots for preset in self.presets()
        ]  # fmt: skip

    def with_seeds(self, seeds: Sequence[int]) -> Plan:
        """The same study with other search seeds."""
        return replace(self, seeds=tuple(seeds))


def _trained(iterations: int, seed: int) -> Robot:
    training = RobotPlan(iterations=iterations, seed=seed)
    return Robot(training.name, training)


PLAN = Plan(
    # Two of the robots of `benchmarks.prediction`: one that has just learned to help, one that was
    # trained as long as the bundled one from another seed. Ours.
    robots=(Robot("vanilla"), _trained(12, 2), _trained(100, 7)),
    standard=PRESETS["standard"],
    paper=PRESETS["paper"],
    seeds=tuple(range(10)),
    recipe=RECIPE,
    command="python -m benchmarks.standard",
)
QUICK = Plan(
    robots=(Robot("vanilla"), _trained(1, 1)),
    standard=replace(
        QUICK_PRESET,
        name="standard-quick",
        sharing=Sharing(wild_slots=2, natural_slots=2),
    ),
    paper=replace(QUICK_PRESET, name="paper-quick"),
    seeds=(0, 1),
    recipe=QUICK_RECIPE,
    command="python -m benchmarks.standard --quick",
    stamp="\n*Quick run: it says nothing about any preset.*\n",
)
