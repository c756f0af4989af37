"""`make paper`: runs the experiments, or goes on with them."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import tyro

from benchmarks.command import Study, start
from rigid.commands.parsing import parse_budget, parse_seeds


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """The paper's experiments with simulated people, from training to tables.

    Trains robots of every recipe for several synthetic humans, measures them all with the same
    search seeds, and writes tables, figures and an account. Robots and results are kept beside the
    account as soon as they are finished, so that the same command goes on, on another machine too.
    Prints first how long it will take: about nine hours on two cores for all of it.

    Examples:
      python -m benchmarks.paper
      python -m benchmarks.paper --preset demo --robot-seeds 0
      python -m benchmarks.paper --for 90m
      python -m benchmarks.paper --quick
    """

    preset: str = "standard"
    """demo, standard or paper: the budget of each frontier."""
    robot_seeds: str = "0,1,2"
    """Seeds of robots and their synthetic humans, as 0,1,2 or 0..2."""
    time: Annotated[str | None, tyro.conf.arg(name="for", metavar="TIME")] = None
    """Begin nothing more after this time (90s, 30m, 2h), and write what stands; by default all."""

    def run(self) -> None:
        """Runs what is missing, then writes everything."""
        from benchmarks.paper.plan import full_plan, quick_plan
        from benchmarks.paper.running import run
        from rigid.presets import find_preset

        seeds = parse_seeds(self.robot_seeds)
        assert seeds is not None  # There is a default.
        preset = find_preset(self.preset)
        name = "paper" if preset.name == "standard" else f"paper-{preset.name}"
        out, results = self.places(name)
        plan = quick_plan() if self.quick else full_plan(preset, seeds)
        run(plan, out=out, results=results, spend=parse_budget(self.time, "--for"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the experiments: 0 done, 2 bad input, 130 interrupted."""
    return start(Options, "paper", arguments)


if __name__ == "__main__":
    sys.exit(main())
