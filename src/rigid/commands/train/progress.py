"""How the progress of a training is shown."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from math import isnan
from typing import TYPE_CHECKING, final

from rigid.commands.parsing import spoken
from rigid.commands.terminal.pace import Pace

if TYPE_CHECKING:
    import rich.progress

    from rigid.commands.terminal.progress import TimeColumn
    from rigid.learning.cooptimisation import Progress
    from rigid.tasks.protocol import Task


@final
class Shown:
    """A bar that hears of a training, as `rigid.robots.storing.Report`."""

    def __init__(
        self, bar: rich.progress.Progress, times: TimeColumn, what: str, iterations: int
    ) -> None:
        self._bar, self._times = bar, times
        self._what, self._iterations = what, iterations
        self._pace = Pace()
        self._task = bar.add_task(what, total=iterations, done=0, start=False, pace=self._pace)
        self._done, self._within, self._per_iteration = 0, 0.0, 1
        self.before: Shown | None = None
        """The stage before this one."""

    def start(self) -> None:
        """Its clock runs from now on, if it does not yet."""
        if self._bar.tasks[self._task].start_time is None:
            self._bar.start_task(self._task)

    def begin(self, task: Task, episodes: int, done: int) -> None:
        """Says how much there is to do, and how long it will take if that is easily found out."""
        if self.before is not None:
            self.before.end()
        self.start()
        self._per_iteration = episodes * task.horizon
        self._go_to(done)
        kept = f", of which {done} are done" if done else ""
        seconds = self._expected(task)
        about = "" if seconds is None else f"; about {spoken(seconds)}"
        work = f"{self._iterations} iterations of {self._per_iteration:,} steps"
        self._say(f"{self._what}: {work}{kept}{about}")

    def _expected(self, task: Task) -> float | None:
        """How long the iterations that are left take, to judge by the task's speed [s]."""
        from rigid.compute.budget import ROBOT_LEARNING_SECONDS, STARTING_SECONDS, training_speed
        from rigid.tasks.protocol import LimitsWorlds

        if isinstance(task, LimitsWorlds):  # Trying it out might take minutes.
            return None
        speed = training_speed(task, ROBOT_LEARNING_SECONDS) / self._per_iteration
        self._pace.expect(speed, STARTING_SECONDS)
        return STARTING_SECONDS + (self._iterations - self._done) / speed

    def watch(self, task: Task) -> Task:
        """The same task, whose steps move the bar within iterations."""
        from rigid.commands.terminal.progress import PATIENCE
        from rigid.tasks.views.watched import watched

        return watched(task, self._step, PATIENCE)

    def __call__(self, progress: Progress) -> None:
        """An iteration is done."""
        self._bar.start()
        self._pace.advance(1)
        seen = f"return {progress.mean_return:.1f}"
        if not isnan(progress.success):  # Of a task that defines none.
            seen += f" · success {progress.success:.2f}"
        self._go_to(progress.iteration + 1)
        self._bar.update(self._task, description=f"{self._what} · {seen}")
        # A bar does not show in a log.
        if not self._bar.console.is_terminal and self._done % 10 == 0:
            left = self._times.rest(self._bar.tasks[self._task])
            self._say(f"{self._what} {self._done}/{self._iterations} · {seen}{left}")

    def end(self) -> None:
        """Another stage follows; this one may have been stored by an earlier call."""
        self._go_to(self._iterations)
        self._bar.update(self._task, description=self._what)
        self._bar.stop_task(self._task)

    def _step(self, env_steps: int) -> None:
        self._within = min(self._within + env_steps / self._per_iteration, 0.99)
        if self._done < self._iterations:  # Afterwards canonical episodes are played.
            self._bar.update(self._task, completed=self._done + self._within)

    def _go_to(self, done: int) -> None:
        self._done, self._within = done, 0.0
        self._bar.update(self._task, completed=done, done=done)

    def _say(self, text: str) -> None:
        whole = not self._bar.console.is_terminal  # A log is searched.
        self._bar.console.print(text, highlight=False, markup=False, soft_wrap=whole)


@contextmanager
def show_progress(what: str, iterations: int) -> Iterator[Shown]:
    """A progress bar over iterations with the newest return and success.

    Args:
        what: Is trained.
        iterations: How many there are.
    """
    with show_stages((what, iterations)) as (shown,):
        yield shown


@contextmanager
def show_stages(*stages: tuple[str, int]) -> Iterator[list[Shown]]:
    """Such a bar for each of several trainings that follow one another, with a clock of its own.

    Args:
        stages: What is trained, and the number of its iterations.
    """
    from rich.console import Console
    from rich.progress import TextColumn
    from rich.table import Column

    from rigid.commands.terminal.progress import TimeColumn, bar_of, drawn_late

    counted = TextColumn("{task.fields[done]}/{task.total}", table_column=Column(no_wrap=True))
    bar = bar_of(Console(stderr=True), counted, times := TimeColumn("storing"))
    shown = [Shown(bar, times, what, iterations) for what, iterations in stages]
    for before, stage in pairwise(shown):
        stage.before = before
    shown[0].start()
    with drawn_late(bar):
        yield shown
