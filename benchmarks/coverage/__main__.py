"""`python -m benchmarks.coverage`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from benchmarks.command import Study, start


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Do the 95 % intervals cover what they say?

    Measures two robots of `analytic/offset-catch` with 64 search seeds each, draws 3 to 10 of those
    seeds many times, and counts how often the printed interval holds the mean of all; then the
    same for laws of known mean, from symmetric to heavily skewed. About 15 minutes on two free
    cores; what is complete is kept, so the same command goes on where it was stopped.

    Examples:
      python -m benchmarks.coverage
      python -m benchmarks.coverage --quick
    """

    def run(self) -> None:
        """Runs the study."""
        from benchmarks.coverage.plan import PLAN, QUICK
        from benchmarks.coverage.running import run

        out, results = self.places("coverage")
        run(QUICK if self.quick else PLAN, out=out, results=results)


if __name__ == "__main__":
    sys.exit(start(Options, "coverage"))
