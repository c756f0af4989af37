"""`python -m benchmarks.measures`: runs the study, or goes on with it."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import tyro

from benchmarks.command import exit_code
from rigid.commands.parsing import parse_seeds


@dataclass(frozen=True, kw_only=True)
class Options:
    """What does each search measure find, and what does it find alone?

    Searches the bundled robot with every measure, all with the same seeds, number of λ and training
    steps, and judges all adversaries on the same axes. Every finished part is kept: the same
    command goes on where it was stopped. About 20 minutes on two cores.

    Examples:
      python -m benchmarks.measures
      python -m benchmarks.measures --seeds 0..7
      python -m benchmarks.measures --quick
    """

    out: Path | None = None
    """Raw runs; runs/measures by default, runs/measures-quick with --quick."""
    results: Path | None = None
    """Tables, figure and account; results/measures by default, OUT/results with --quick."""
    seeds: str | None = None
    """Search seeds, as 0,1,2 or 0..9; 0,1,2 by default. More may be added to a finished study."""
    quick: bool = False
    """The whole road in two minutes, with budgets that say nothing about any measure."""

    def run(self) -> None:
        """Runs the study."""
        seeds = parse_seeds(self.seeds)
        from benchmarks.measures.plan import PLAN, QUICK
        from benchmarks.measures.running import run

        plan = QUICK if self.quick else PLAN
        out = self.out or Path("runs/measures-quick" if self.quick else "runs/measures")
        usual = out / "results" if self.quick else Path("results/measures")
        run(plan if seeds is None else plan.with_seeds(seeds), out=out,
            results=self.results or usual)  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    options = tyro.cli(
        Options, args=arguments, prog="python -m benchmarks.measures",
        description=inspect.getdoc(Options), config=(tyro.conf.FlagCreatePairsOff,),
    )  # fmt: skip
    return exit_code("measures", options.run)


if __name__ == "__main__":
    sys.exit(main())
