"""`python -m benchmarks.physics`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.command import Study, start


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Is itch scratching's physics step of 0.02 s fine enough?

    Plays the same episodes with 0.02 s × 5, 0.01 s × 10, 0.005 s × 20 and 0.002 s × 50, at equal
    stiffness of contacts, first with policies that act in each, then with recorded targets over
    half seconds; lets the bodies swing without drive; and measures what a finer step costs. About
    10 minutes on one free core; what is complete is kept, so the same command goes on where it was
    stopped.

    Examples:
      python -m benchmarks.physics
      python -m benchmarks.physics --quick
    """

    def run(self) -> None:
        """Runs the study."""
        from benchmarks.physics.plan import PLAN, QUICK
        from benchmarks.physics.running import run

        out, results = self.places("physics")
        run(QUICK if self.quick else PLAN, out=out, results=results)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    return start(Options, "physics", arguments)


if __name__ == "__main__":
    sys.exit(main())
