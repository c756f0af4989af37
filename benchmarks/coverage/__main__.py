"""`python -m benchmarks.coverage`: runs the study, or goes on with it."""

from __future__ import annotations

import inspect
import sys
from dataclasses import dataclass
from pathlib import Path

import tyro

from rigid.errors import UserError


@dataclass(frozen=True, kw_only=True)
class Options:
    """Do the 95 % intervals cover what they say?

    Measures two robots of the analytic hand-over with 64 search seeds each, draws 3 to 10 of those
    seeds many times, and counts how often the printed interval holds the mean of all; then the
    same for laws of known mean, from symmetric to heavily skewed. About 15 minutes on two free
    cores; what is complete is kept, so the same command goes on where it was stopped.

    Examples:
      python -m benchmarks.coverage
      python -m benchmarks.coverage --quick
    """

    out: Path | None = None
    """Raw runs; runs/coverage by default, runs/coverage-quick with --quick."""
    results: Path | None = None
    """Tables, figure and account; results/coverage by default, OUT/results with --quick."""
    quick: bool = False
    """The whole road in two minutes, with budgets that say nothing about any interval."""


def main() -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    options = tyro.cli(
        Options, prog="python -m benchmarks.coverage", description=inspect.getdoc(Options),
        config=(tyro.conf.FlagCreatePairsOff,),
    )  # fmt: skip
    from benchmarks.coverage.plan import PLAN, QUICK
    from benchmarks.coverage.running import run

    out = options.out or Path("runs/coverage-quick" if options.quick else "runs/coverage")
    usual = out / "results" if options.quick else Path("results/coverage")
    try:
        run(QUICK if options.quick else PLAN, out=out, results=options.results or usual)
    except UserError as error:
        print(f"coverage: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"\ncoverage: interrupted; the same command goes on in {out}", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
