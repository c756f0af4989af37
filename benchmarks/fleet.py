"""`python -m benchmarks.fleet RUN…`: how long a fleet takes on a cluster, from finished runs."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from rigid.commands.parsing import at_least, printable, spoken
from rigid.errors import UserError
from rigid.frontier.result import Frontier, load_frontier

_APART = 0.9
"""A driver that was busy for a larger share of its run did the groups as well. Ours."""


@dataclass(frozen=True)
class Costs:
    """What one robot costs, the mean of measured runs."""

    driver: float
    """Seconds that the driver works for it; one robot after the other."""
    workers: float
    """Processor seconds of its groups: training, scoring and referees of all seeds."""
    seeds: float
    """Search seeds, whose groups run side by side."""

    @classmethod
    def of(cls, frontiers: Sequence[Frontier]) -> Costs:
        """Those of finished runs.

        Raises:
            UserError: A run does not say what its driver took.
        """
        found = [_costs(frontier) for frontier in frontiers]
        return cls(*(sum(column) / len(found) for column in zip(*found, strict=True)))

    @property
    def chain(self) -> float:
        """Seconds from a robot's begin to its end on workers enough: its groups in a row."""
        return self.driver + self.workers / self.seeds

    @property
    def useful_workers(self) -> float:
        """Workers that one driver keeps busy; more of them wait for it."""
        return self.workers / self.driver

    def wall(self, robots: int, workers: int) -> dict[str, float]:
        """The three bounds of the wall time [s]; the largest is what to expect.

        Example:
            >>> Costs(driver=10.0, workers=400.0, seeds=8.0).wall(robots=100, workers=20)
            {'driver': 1000.0, 'workers': 2000.0, 'chain': 60.0}
        """
        return {
            "driver": robots * self.driver,
            "workers": robots * self.workers / workers,
            "chain": self.chain,
        }


@dataclass(frozen=True)
class Options:
    """How long a fleet takes on a cluster, from the figures of finished runs.

    The runs should be of the fleet's preset and seeds, and measured with `--executor ray`, which
    tells the driver's time from that of workers. docs/scaling.md says what the model leaves out.

    Examples:
      python -m benchmarks.fleet runs/fleet/* --robots 1000 --workers 64
      python -m benchmarks.fleet runs/one --robots 4 --workers 2 --measured 1830
    """

    runs: Annotated[tuple[Path, ...], tyro.conf.Positional]
    """Finished run directories."""
    robots: int = 1000
    """Robots of the fleet."""
    workers: int = 64
    """Groups that run at a time: CPUs that Ray has."""
    measured: float | None = None
    """Wall time of such a fleet that was really measured [s], to be held against the model."""

    def run(self) -> None:
        """Prints the model."""
        at_least("--robots", self.robots, 1)
        at_least("--workers", self.workers, 1)
        if not self.runs:
            raise UserError("name finished run directories")
        costs = Costs.of([load_frontier(run) for run in self.runs])
        print(account(costs, self.robots, self.workers, self.measured))


def account(costs: Costs, robots: int, workers: int, measured: float | None) -> str:
    """The model in words."""
    bounds = costs.wall(robots, workers)
    longest = max(bounds, key=bounds.__getitem__)
    driver, groups = f"{costs.driver:.1f} s of the driver", f"{costs.workers:.0f} core-s of workers"
    lines = [
        f"one robot: {driver}, {groups}, {costs.chain:.0f} s at least",
        f"{robots} robots on {workers} workers:",
        *(
            f"  {spoken(seconds):>12}  {name}{'  ← longest' if name == longest else ''}"
            for name, seconds in bounds.items()
        ),
        f"one driver keeps {costs.useful_workers:.0f} workers busy",
    ]
    if measured is not None:
        ratio = measured / bounds[longest]
        lines.append(f"measured: {spoken(measured)}, {ratio:.2f} times the longest")
    return "\n".join(lines)


def _costs(frontier: Frontier) -> tuple[float, float, float]:
    data = frontier.data
    driver = data.get("driver_seconds")
    if driver is None or not 0 < driver < _APART * data["wall_seconds"]:
        raise UserError(
            f"{frontier.directory} does not tell the driver's time from that of workers: measure "
            "it with --executor ray"
        )
    # The driver computes while it works, so this leaves to the workers no less than they took.
    return driver, data["core_seconds"] - driver, len(data["auc_by_seed"])


def main(arguments: Sequence[str] | None = None) -> int:
    """Prints the model: 0 done, 2 bad input."""
    options = tyro.cli(
        Options, args=arguments, prog="python -m benchmarks.fleet",
        description=inspect.getdoc(Options),
    )  # fmt: skip
    try:
        options.run()
    except UserError as error:
        print(f"fleet: {printable(str(error))}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
