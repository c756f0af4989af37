"""`python -m benchmarks.planted`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from benchmarks.command import Study, start


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Ten robots with a planted weakness and ten decoys: what does each search find?

    Every finished part is kept, and the same command goes on. About an hour on two idle cores.

    Examples:
      python -m benchmarks.planted
      python -m benchmarks.planted --quick
    """

    def run(self) -> None:
        """Runs the study."""
        from benchmarks.planted.plan import PLAN, QUICK
        from benchmarks.planted.running import run

        out, results = self.places("planted")
        run(QUICK if self.quick else PLAN, out=out, results=results)


if __name__ == "__main__":
    sys.exit(start(Options, "planted"))
