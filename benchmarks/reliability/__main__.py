"""`python -m benchmarks.reliability`: runs the study, or goes on with it."""

from __future__ import annotations

import inspect
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import tyro

from rigid.errors import UserError

if TYPE_CHECKING:
    from benchmarks.reliability.plan import Plan


@dataclass(frozen=True, kw_only=True)
class Options:
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
    out: Path | None = None
    """Raw runs; runs/reliability/PRESET by default, runs/reliability-quick with --quick."""
    results: Path | None = None
    """Tables, figure and account; results/reliability by default, OUT/results with --quick."""
    quick: bool = False
    """The whole road in two minutes, on a task that says nothing about any robot."""


def main() -> int:
    """Runs the study: 0 done, 2 bad input, 130 interrupted."""
    options = tyro.cli(
        Options, prog="python -m benchmarks.reliability", description=inspect.getdoc(Options),
        config=(tyro.conf.FlagCreatePairsOff,),
    )  # fmt: skip
    from benchmarks.reliability.running import run

    usual = "reliability-quick" if options.quick else f"reliability/{options.preset}"
    out = options.out or Path("runs") / usual
    results = out / "results" if options.quick else Path("results/reliability")
    try:
        run(_plan(options), out=out, results=options.results or results)
    except UserError as error:
        print(f"reliability: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"\nreliability: interrupted; the same command goes on in {out}", file=sys.stderr)
        return 130
    return 0


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
    sys.exit(main())
