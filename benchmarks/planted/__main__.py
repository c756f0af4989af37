"""`python -m benchmarks.planted`: planted weaknesses, decoys, and who finds what."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import tyro

from benchmarks.command import exit_code


@dataclass(frozen=True, kw_only=True)
class Planted:
    """Ten robots with a planted weakness and ten decoys: what does each search find?

    Every finished part is kept, and the same command goes on. About an hour on two idle cores.

    Examples:
      python -m benchmarks.planted
      python -m benchmarks.planted --quick --out /tmp/quick --results /tmp/quick-results
    """

    out: Path = Path("runs/planted")
    """Where the parts are kept."""
    results: Path = Path("results/planted")
    """Where table, figure and account go."""
    quick: bool = False
    """Two robots and tiny budgets: shows that the road works, and nothing else."""

    def run(self) -> None:
        """Makes what is missing, then writes the results."""
        from benchmarks.planted.plan import FULL, QUICK
        from benchmarks.planted.running import run

        run(QUICK if self.quick else FULL, self.out, self.results)


if __name__ == "__main__":
    sys.exit(exit_code("benchmarks.planted", tyro.cli(Planted, prog="benchmarks.planted").run))
