"""`python -m benchmarks.prediction`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from benchmarks.command import Study, start


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Does the frontier predict how a robot does with people it was never measured with?

    Trains robots of different robustness for one synthetic human, measures the frontier of each,
    lets each meet humans whom no search has seen, and correlates. Every finished part is kept: the
    same command goes on where it was stopped.

    Examples:
      python -m benchmarks.prediction
      python -m benchmarks.prediction --quick
    """

    def run(self) -> None:
        """Runs the study."""
        from benchmarks.prediction.plan import PLAN, QUICK
        from benchmarks.prediction.running import run

        out, results = self.places("prediction")
        run(QUICK if self.quick else PLAN, out=out, results=results)


if __name__ == "__main__":
    sys.exit(start(Options, "prediction"))
