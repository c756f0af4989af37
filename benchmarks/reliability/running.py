"""The study from its measurements to its account."""

from __future__ import annotations

from pathlib import Path

from benchmarks.reliability.account import write_account
from benchmarks.reliability.drawing import draw
from benchmarks.reliability.plan import NUMBERS, Plan
from benchmarks.reliability.spread import measurement_rows, pair_rows, spread_of
from benchmarks.study import say, write_table
from rigid.commands.parsing import spoken
from rigid.commands.terminal.progress import TerminalListener
from rigid.compute.budget import FIXED_SECONDS, training_speed
from rigid.compute.measurement import measure_robot
from rigid.compute.subject import Subject
from rigid.frontier.comparison import Number, numbers_of


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Makes what is missing in `out`, then writes everything into `results`.

    Raises:
        UserError: `out` holds measurements of something else, or cannot be written.
    """
    missing = [
        one for one in range(1, plan.measurements + 1)
        if not (out / str(one) / "frontier.json").exists()
    ]  # fmt: skip
    if missing:
        steps = plan.preset.env_steps(plan.task.horizon)
        seconds = len(missing) * (FIXED_SECONDS + steps / training_speed(plan.task))
        say(f"{len(missing)} of {plan.measurements} measurements to go: about {spoken(seconds)}")
    measured = [_measured(plan, one, out / str(one)) for one in range(1, plan.measurements + 1)]
    spreads = {name: spread_of([numbers[name] for numbers in measured]) for name in NUMBERS}
    pairs = pair_rows(measured)
    write_table(results / "table.csv", pairs)
    write_table(results / "measurements.csv", measurement_rows(measured))
    draw(results / "figure.svg", measured, pairs)
    write_account(results / "README.md", plan, spreads, measured, pairs)
    say(f"written: {results / 'README.md'}")


def _measured(plan: Plan, measurement: int, out: Path) -> dict[str, Number]:
    """One whole measurement, with canonical play, referees and search seeds of its own."""
    subject = Subject(plan.task, plan.robot, canonical_draw=measurement)
    with TerminalListener(f"measurement {measurement} of {plan.measurements}") as listener:
        frontier = measure_robot(
            subject, plan.preset, out=out, seeds=plan.seeds(measurement), listener=listener
        )
    return numbers_of(frontier)
