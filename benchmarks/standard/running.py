"""The study from its plan to its account, which is written anew after every pair."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

from benchmarks.standard.account import account
from benchmarks.standard.checking import check_parts, makers
from benchmarks.standard.costs import cost_rows
from benchmarks.standard.drawing import draw
from benchmarks.standard.making import Workplace
from benchmarks.standard.pairing import pairs_of, seed_rows, table_rows, with_pooled
from benchmarks.standard.plan import Part, Plan
from benchmarks.standard.work import Work, training_seconds, work_of
from benchmarks.study import say, write_table
from rigid.commands.parsing import spoken
from rigid.commands.terminal.progress import TerminalListener
from rigid.compute.budget import training_speed
from rigid.compute.executors.executor import Executor, on_this_machine
from rigid.compute.listening import Silence, Workload
from rigid.compute.measurement import measure_each
from rigid.compute.robot_run import Order
from rigid.compute.run.directory import alone_in
from rigid.compute.threads import fix_xla_threads
from rigid.files import make_room, write_atomically


def run(plan: Plan, *, out: Path, results: Path, limit: float | None = None) -> None:
    """Makes what `results` does not keep yet, seed by seed, and writes what is known.

    Args:
        plan: The study.
        out: Raw runs; those that are under way go on.
        results: Finished parts and robots, and what is written of them.
        limit: Time [s] from now; no part is begun that would not be finished by then.

    Raises:
        UserError: `out` or `results` hold parts of another plan, a directory cannot be written, or
            another process is at it.
    """
    begun = time.monotonic()
    fix_xla_threads()  # Before a robot's training starts JAX: numbers depend on its threads.
    make_room(results / "README.md", "--results")
    with alone_in(out):
        place = Workplace(plan, out, results)
        speed = training_speed(place.task)
        parts, total = place.missing(), len(plan.parts())
        executor = _executor(place, parts)
        expected = training_seconds(place, speed) + work_of(place, parts, executor, speed).expected
        say(f"{len(parts)} of {total} measurements to go: about {spoken(expected)}")
        place.make_robots()
        check_parts(place)
        place.keep_finished()
        if any(place.is_kept(part) and place.is_kept(part.other) for part in place.kept_parts()):
            write_results(place)
        work = work_of(place, place.missing(), executor, speed)
        if work.parts:
            left = None if limit is None else limit - (time.monotonic() - begun)
            measure_missing(place, executor, work, left)


def measure_missing(place: Workplace, executor: Executor, work: Work, limit: float | None) -> None:
    """Measures what is missing in one pool; keeps each part once finished, writes after each pair.

    Args:
        place: Where everything lies.
        executor: Who measures.
        work: What is missing.
        limit: Time for all of it [s]; None: as long as it takes.
    """
    parts, total = place.missing(), len(place.plan.parts())
    with TerminalListener("standard against paper") as terminal:
        terminal.expect(sum(_steps(place, part) for part in parts))
        orders = orders_in_time(place, work, limit, terminal)
        with closing(measure_each(orders, executor)) as complete:
            for order in complete:
                part = next(part for part in parts if place.raw(part) == order.out)
                place.keep(part)
                work.finish(part)
                left = spoken(work.left)
                say(f"measured: {part.name}; {work.parts} of {total} to go: about {left}")
                if place.is_kept(part.other):
                    write_results(place)


def orders_in_time(
    place: Workplace, work: Work, limit: float | None, terminal: TerminalListener
) -> Iterator[Order]:
    """Orders of missing parts, as long as each would be finished in time."""
    begun = time.monotonic()
    for part in place.missing():
        seconds = work.seconds_with(part)
        if limit is not None and time.monotonic() - begun + seconds > limit:
            say(f"no time for more: {part.name} would take about {spoken(seconds)}")
            return
        work.begin(part)
        yield place.order(part, _OnePart(part, work, _steps(place, part), terminal))


def write_results(place: Workplace) -> None:
    """Writes tables, figure and account of all pairs that are complete."""
    results = place.results
    measured = {robot.name: place.frontiers(robot) for robot in place.plan.robots}
    robots = [pair for name, runs in measured.items() for pair in pairs_of(name, runs)]
    pairs = with_pooled(robots)
    rows, costs = table_rows(pairs), cost_rows(measured)
    write_table(results / "table.csv", rows)
    write_table(results / "seeds.csv", seed_rows(robots))
    write_table(results / "costs.csv", costs)
    draw(results / "figure.svg", pairs, rows)
    plan = place.plan.with_seeds(place.seeds())
    text = account(plan, measured, rows, costs, makers(place))
    write_atomically(results / "README.md", text.encode())
    say(f"written: {results / 'README.md'}")


def _executor(place: Workplace, parts: Sequence[Part]) -> Executor:
    """Who measures: a process for each core, where that pays."""
    orders = [place.order(part, Silence()) for part in parts]
    steps = sum(order.env_steps for order in orders)
    return on_this_machine(max(len(orders), 1), steps, [order.subject for order in orders[:1]])


def _steps(place: Workplace, part: Part) -> int:
    """Environment steps of a part's training and scoring."""
    preset, horizon = place.plan.search(part.preset), place.task.horizon
    return preset.env_steps(horizon) + preset.scoring_steps(preset.adversaries, horizon)


class _OnePart:
    """Listens to the measurement of one part, for the one bar of all."""

    def __init__(self, part: Part, work: Work, steps: int, terminal: TerminalListener) -> None:
        self._part, self._work, self._steps, self._terminal = part, work, steps, terminal
        self._done = 0

    def begin(self, work: Workload) -> None:
        """The bar of all parts is there already."""
        self._done = work.done
        self._terminal.resume(work)

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call."""
        self._done += env_steps
        self._work.advance(self._part, self._done / self._steps)
        self._terminal.advance(env_steps)

    def say(self, text: str) -> None:
        """A line for the user."""
        self._terminal.say(f"{self._part.name}: {text}")
