"""`python -m benchmarks.reliability`: runs the study, or goes on with it."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from benchmarks.command import Study, start

if TYPE_CHECKING:
    from benchmarks.reliability.plan import Plan


@dataclass(frozen=True, kw_only=True)
class Options(Study):
    """Does a measurement say the same when everything but the robot is drawn anew?

    Measures one robot several times on itch scratching, each time with new canonical data, new
    referees and new search seeds, and sets the spread of the results beside the one that each
    measurement predicts from its own seeds. Takes hours with preset standard and prints an
    estimate first; what is complete is kept, so the same command goes on where it was stopped.

    Examples:
      python -m benchmarks.reliability
      python -m benchmarks.reliability --preset demo --measurements 4
      python -m benchmarks.reliability --quick
    """

    robot: str = "builtin:vanilla"
    """builtin:NAME or a native policy directory."""
    preset: str = "standard"
    """demo, standard or paper: the budget of each measurement."""
    measurements: int = 6
    """How many, two or more."""

    def run(self) -> None:
        """Runs the study."""
        from benchmarks.reliability.running import run

        # Runs of another preset are other measurements.
        out, results = self.places("reliability", runs=f"reliability/{self.preset}")
        run(_plan(self), out=out, results=results)


def _plan(options: Options) -> Plan:
    from benchmarks.reliability.plan import Plan
    from rigid.presets import Preset, find_preset
    from rigid.tasks.registry import make_task

    if options.quick:
        return Plan(
            task=make_task("analytic/offset-catch", cost="failure", tolerance=1.0),
            robot="builtin:catcher",
            preset=Preset(
                name="reliability-quick", seeds=(0, 1), per_round=(2,), iterations=3, episodes=600,
                scoring_episodes=200, referee_episodes=100, validation_episodes=50,
            ),
            measurements=3,
            command="python -m benchmarks.reliability --quick",
            stamp="\n*Quick run: it says nothing about any robot.*\n",
        )  # fmt: skip
    return Plan(
        task=make_task("itch-scratching"),
        robot=options.robot,
        preset=find_preset(options.preset),
        measurements=options.measurements,
        command=f"python -m benchmarks.reliability --robot {options.robot} "
        f"--preset {options.preset} --measurements {options.measurements}",
    )


if __name__ == "__main__":
    sys.exit(start(Options, "reliability"))
