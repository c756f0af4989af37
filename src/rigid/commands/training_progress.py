"""How the progress of a training is shown."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from math import isnan
from typing import TYPE_CHECKING, final

from rigid.commands.pace import Pace

if TYPE_CHECKING:
    import rich.progress

    from rigid.commands.progress import TimeColumn
    from rigid.learning.cooptimisation import Progress
    from rigid.tasks.protocol import Task


@final
class Shown:
    """Told after every iteration, as `rigid.robots.storing.Report`; and within one, if asked."""

    def __init__(
        self, bar: rich.progress.Progress, times: TimeColumn, what: str, iterations: int
    ) -> None:
        self._bar, self._times = bar, times
        self._what, self._iterations = what, iterations
        self._pace = Pace()
        self._task = bar.add_task(what, total=iterations, done=0, start=False, pace=self._pace)
        self._done, self._within = 0, 0.0
        self.then: Shown | None = None
        """The stage that follows."""

    def start(self) -> None:
        """Its clock runs from now on, if it does not yet."""
        if self._bar.tasks[self._task].start_time is None:
            self._bar.start_task(self._task)

    def __call__(self, progress: Progress) -> None:
        """An iteration is done."""
        self._bar.start()
        self.start()  # Of a stage before it nothing is heard when that was stored earlier.
        self._pace.advance(1)
        seen = f"return {progress.mean_return:.1f}"
        if not isnan(progress.success):  # Of a task that defines none.
            seen += f" · success {progress.success:.2f}"
        self._done, self._within = progress.iteration + 1, 0.0
        self._bar.update(
            self._task, completed=self._done, done=self._done, description=f"{self._what} · {seen}"
        )
        # A bar does not show in a log.
        if not self._bar.console.is_terminal and self._done % 10 == 0:
            counted = f"{self._what} {self._done}/{self._iterations}"
            left = self._times.rest(self._bar.tasks[self._task])
            self._bar.console.print(f"{counted} · {seen}{left}", highlight=False, soft_wrap=True)
        if self._done == self._iterations and self.then is not None:
            self._bar.stop_task(self._task)
            self.then.start()

    def within(self, task: Task, episodes: int) -> Task:
        """The same task, whose steps move the bar within iterations of so many episodes.

        How long they take is expected from the task's speed.
        """
        from rigid.commands.progress import PATIENCE
        from rigid.compute.budget import STARTING_SECONDS, training_speed
        from rigid.tasks.views.watched import watched

        per_iteration = episodes * task.horizon
        self._pace.expect(training_speed(task) / per_iteration, STARTING_SECONDS)

        def tell(env_steps: int) -> None:
            self._within = min(self._within + env_steps / per_iteration, 0.99)
            if self._done < self._iterations:  # Afterwards canonical episodes are played.
                self._bar.update(self._task, completed=self._done + self._within)

        return watched(task, tell, PATIENCE)


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

    from rigid.commands.progress import TimeColumn, bar_of, drawn_late

    counted = TextColumn("{task.fields[done]}/{task.total}", table_column=Column(no_wrap=True))
    bar = bar_of(Console(stderr=True), counted, times := TimeColumn("storing"))
    shown = [Shown(bar, times, what, iterations) for what, iterations in stages]
    for stage, then in pairwise(shown):
        stage.then = then
    shown[0].start()
    with drawn_late(bar):
        yield shown
