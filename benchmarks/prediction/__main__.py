"""`python -m benchmarks.prediction`: runs the study, or goes on with it."""

from __future__ import annotations

import inspect
import sys
from dataclasses import dataclass
from pathlib import Path

import tyro

from rigid.errors import UserError


@dataclass(frozen=True, kw_only=True)
class Options:
    """Does the frontier predict how a robot does with people it was never measured with?

    Trains robots of different robustness for one synthetic human, measures the frontier of each,
    lets each meet humans whom no search has seen, and correlates. Every finished part is kept: the
    same command goes on where it was stopped.

    Examples:
      python -m benchmarks.prediction
      python -m benchmarks.prediction --quick
    """

    out: Path | None = None
    """Raw runs; runs/prediction by default, runs/prediction-quick with --quick."""
    results: Path | None = None
    """Tables, figure and account; results/prediction by default, OUT/results with --quick."""
    quick: bool = False
    """The whole road in about two minutes, with budgets that say nothing about any robot."""


def main() -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    options = tyro.cli(
        Options, prog="python -m benchmarks.prediction", description=inspect.getdoc(Options),
        config=(tyro.conf.FlagCreatePairsOff,),
    )  # fmt: skip
    from benchmarks.prediction.plan import PLAN, QUICK
    from benchmarks.prediction.running import run

    out = options.out or Path("runs/prediction-quick" if options.quick else "runs/prediction")
    usual = out / "results" if options.quick else Path("results/prediction")
    try:
        run(QUICK if options.quick else PLAN, out=out, results=options.results or usual)
    except UserError as error:
        print(f"prediction: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"\nprediction: interrupted; the same command goes on in {out}", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
