"""`python -m benchmarks.ablations`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.command import Study, start
from rigid.commands.parsing import parse_seeds


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Which stabilisers of the discriminator matter, and how much canonical data does it need?

    Trains adversaries with one choice of the search changed at a time, all with the same seeds and
    λ, and judges them alike; then reads fixed humans with more and more canonical episodes. Every
    finished part is kept: the same command goes on where it was stopped. About 20 minutes on two
    cores.

    Examples:
      python -m benchmarks.ablations
      python -m benchmarks.ablations --seeds 0..7
      python -m benchmarks.ablations --quick
    """

    seeds: str | None = None
    """Search seeds, as 0,1,2 or 0..9; 0,1,2 by default. More may be added to a finished study."""

    def run(self) -> None:
        """Runs the study."""
        seeds = parse_seeds(self.seeds)
        from benchmarks.ablations.plan import PLAN, QUICK
        from benchmarks.ablations.running import run

        plan = QUICK if self.quick else PLAN
        out, results = self.places("ablations")
        run(plan if seeds is None else plan.with_seeds(seeds), out=out, results=results)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    return start(Options, "ablations", arguments)


if __name__ == "__main__":
    sys.exit(main())
