"""`python -m benchmarks.standard`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.command import Study, start
from rigid.commands.parsing import parse_seeds


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Is preset `standard` as good as preset `paper`?

    Measures three robots with both presets, paired by robot and search seed: first seed 0 of
    everything, then seed 1, and so on. Takes about ten hours on two idle cores and prints an
    estimate first. After each seed the account is written from all that is complete; the same
    command goes on where it was stopped.

    Examples:
      python -m benchmarks.standard
      python -m benchmarks.standard --seeds 0..3
      python -m benchmarks.standard --quick
    """

    seeds: str | None = None
    """Search seeds, as 0,1,2 or 0..9; 0..9 by default. More may be added to a finished study."""

    def run(self) -> None:
        """Runs the study."""
        seeds = parse_seeds(self.seeds)
        from benchmarks.standard.plan import PLAN, QUICK
        from benchmarks.standard.running import run

        plan = QUICK if self.quick else PLAN
        out, results = self.places("standard")
        run(plan if seeds is None else plan.with_seeds(seeds), out=out, results=results)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    return start(Options, "standard", arguments)


if __name__ == "__main__":
    sys.exit(main())
