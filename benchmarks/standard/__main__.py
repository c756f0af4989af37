"""`python -m benchmarks.standard`: runs the study, or goes on with it."""

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
    """Is preset `standard` as good as preset `paper`?

    Measures three robots with both presets, paired by robot and search seed: first seed 0 of
    everything, then seed 1, and so on, a part on each core. Takes about ten hours on two idle cores
    and prints an estimate first. Each finished part is kept in RESULTS at once, and after each pair
    the account is written from all that is there. The same command goes on from what RESULTS holds,
    also on another machine; parts under way go on where OUT holds them. Machines share the work by
    seeds: give each the same RESULTS/robots first, then their folders of RESULTS/runs add up.

    Examples:
      python -m benchmarks.standard
      python -m benchmarks.standard --for 90m
      python -m benchmarks.standard --seeds 0..3
      python -m benchmarks.standard --quick
    """

    seeds: str | None = None
    """Search seeds, as 0,1,2 or 0..9; 0..9 by default. More may be added to a finished study."""
    limit: Annotated[str | None, tyro.conf.arg(name="for")] = None
    """Time to spend, as 90m or 2h: no part is begun that would not be finished by then."""

    def run(self) -> None:
        """Runs the study."""
        seeds, limit = parse_seeds(self.seeds), parse_budget(self.limit, "--for")
        from benchmarks.standard.plan import PLAN, QUICK
        from benchmarks.standard.running import run

        plan = QUICK if self.quick else PLAN
        out, results = self.places("standard")
        wanted = plan if seeds is None else plan.with_seeds(seeds)
        run(wanted, out=out, results=results, limit=limit)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    return start(Options, "standard", arguments)


if __name__ == "__main__":
    sys.exit(main())
