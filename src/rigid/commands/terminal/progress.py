"""Progress on the terminal: an estimate before the start, a bar with time left, and plain lines.

Everything goes to standard error, so that `--json` leaves standard output to the result.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from threading import Timer
from types import TracebackType
from typing import TYPE_CHECKING, TypeVar, final

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn
from rich.progress import Task as Bar
from rich.table import Column
from rich.text import Text

from rigid.commands.parsing import spoken
from rigid.commands.terminal.pace import Pace
from rigid.interrupts import interrupts_held

if TYPE_CHECKING:
    from rigid.compute.listening import Workload
    from rigid.tasks.protocol import Task

_Item = TypeVar("_Item")
PATIENCE = 2.0
"""Seconds after which people want to see that something moves. Ours."""
_MEMORY = 120.0
"""Seconds over which the speed is taken. Ours: one iteration of a slow task may take a minute."""


@final
class TimeColumn(ProgressColumn):
    """How long it has taken, and how long it will take: two times that cannot be mixed up."""

    max_refresh = 0.5

    def __init__(self, after: str, then: str = "") -> None:
        """A column of bars; of each that has a field `pace`, that one knows the time left.

        Args:
            after: What is done once a bar is full, and goes on while its clock does.
            then: What follows with a bar of its own.
        """
        super().__init__(Column(no_wrap=True))  # The bar gives way on a narrow terminal.
        self.after = after
        self._then = f" + {then}" if then else ""

    def render(self, task: Bar) -> Text:
        """The times of one bar."""
        if task.elapsed is None:  # Another one comes first.
            return Text("")
        if task.stop_time is not None:  # Another one followed.
            return Text(clock(task.elapsed))
        return Text(f"{clock(task.elapsed)} so far{self.rest(task)}")

    def rest(self, task: Bar) -> str:
        """What is still to come."""
        if task.finished:
            return f" · {self.after}"
        pace: Pace | None = task.fields.get("pace")
        if pace is None:
            left = task.time_remaining
        else:
            left = None if task.remaining is None else pace.left(task.remaining)
        if left is None:
            return ""
        compiling = " · compiling" if pace is not None and pace.compiling else ""
        return f"{compiling} · {spoken(left)} left{self._then}"


@final
class ShareColumn(ProgressColumn):
    """The share that is done, as long as it is known."""

    def __init__(self) -> None:
        super().__init__(Column(no_wrap=True))

    def render(self, task: Bar) -> Text:
        """The share of one bar."""
        return Text("" if task.total is None else f"{task.percentage:>3.0f} %")


def clock(seconds: float) -> str:
    """A time as a watch shows it.

    Example:
        >>> clock(75), clock(3700)
        ('1:15', '1:01:40')
    """
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


@final
class _Whole(Progress):
    """Bars that an interrupt finds drawn or not drawn: half drawn, they could not be ended."""

    def start(self) -> None:
        """Draws them."""
        with interrupts_held():
            super().start()

    def stop(self) -> None:
        """Draws them for the last time, and gives the cursor back."""
        with interrupts_held():
            super().stop()


def bar_of(console: Console, *columns: ProgressColumn) -> Progress:
    """A bar with a description, and `columns` after it."""
    shown = (TextColumn("{task.description}"), BarColumn(), *columns)
    return _Whole(*shown, console=console, speed_estimate_period=_MEMORY)


@contextmanager
def drawn_late(bar: Progress) -> Iterator[None]:
    """Draws a bar once people would wonder, so that one of a command that is refused never shows.

    Whoever knows sooner that there is something to see starts it.
    """
    timer = Timer(PATIENCE, bar.start)
    timer.daemon = True
    if bar.console.is_terminal:
        timer.start()
    try:
        yield
    finally:
        timer.cancel()
        if timer.is_alive():
            timer.join()
        if bar.live.is_started:
            bar.stop()


@final
class TerminalListener:
    """Tells the terminal how a measurement goes on; use as a context manager.

    As long as nobody knows how much there is to do, the bar pulses. A listener that shows something
    else holds one and passes on what it wants shown.
    """

    def __init__(self, what: str, then: str = "") -> None:
        """Says nothing yet.

        Args:
            what: Is done.
            then: What follows with a bar of its own, and is not in the time left.
        """
        self._what, self._then = what, f", then the {then}" if then else ""
        self._console = Console(stderr=True)
        self._pace = Pace()
        self._times = TimeColumn("summing up", then)
        self._bar = bar_of(self._console, ShareColumn(), self._times)
        self._task = self._bar.add_task(what, total=None, pace=self._pace)
        self._late = drawn_late(self._bar)

    def __enter__(self) -> TerminalListener:
        self._late.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        bar = self._bar.tasks[0]
        if kind is None:
            self._times.after = "done"
            self._bar.update(self._task, completed=bar.total)
        self._bar.live.transient = bar.total is None  # One that never began leaves nothing.
        self._late.__exit__(kind, error, trace)

    def begin(self, work: Workload) -> None:
        """Work starts, or goes on."""
        share = 100 * work.done / work.steps
        done = f", of which {share:.0f} % are done" if work.done else ""
        about = f"about {spoken(work.seconds)}{self._then}"
        self.say(f"{work.training_steps:,} training steps{done}; {about}")
        self.expect(work.steps)
        self.resume(work)

    def resume(self, work: Workload) -> None:
        """Steps of earlier calls are among those that the bar stands for; the speed is a guess."""
        self._bar.advance(self._task, work.done)
        if not self._pace.expected:
            self._pace.expect(work.steps_per_second, work.starting)

    def expect(self, steps: int, after: str = "summing up") -> None:
        """Steps that the bar stands for, from now on, and what is done after the last."""
        self._times.after = after
        self._bar.update(self._task, total=steps)
        self._bar.start()

    def advance(self, steps: int) -> None:
        """Steps done since the last call."""
        bar = self._bar.tasks[0]
        if bar.total is None:
            return
        self._pace.advance(steps)
        before = bar.percentage
        self._bar.advance(self._task, steps)
        # A bar does not show in a log.
        if not self._console.is_terminal and bar.percentage // 5 > before // 5:
            self.say(f"{self._what}: {bar.percentage:.0f} %{self._times.rest(bar)}")

    def say(self, text: str) -> None:
        """A line for the user."""
        whole = not self._console.is_terminal  # A log is searched.
        self._console.print(text, highlight=False, markup=False, soft_wrap=whole)


def counted(what: str, items: Collection[_Item]) -> Iterator[_Item]:
    """The items, with a bar that advances as they are taken.

    Args:
        what: Is done with them.
        items: Of which each takes about as long.
    """
    with TerminalListener(what) as listener:
        listener.expect(len(items))
        for item in items:
            yield item
            listener.advance(1)


@contextmanager
def playing(task: Task, episodes: int, batch: int) -> Iterator[Task]:
    """The same task, with a bar while episodes are played in it, if that takes its time.

    Args:
        task: Any.
        episodes: How many are played.
        batch: How many at a time; those of the last block that are too many are played as well.
    """
    from rigid.tasks.views.watched import watched

    steps = -(-episodes // batch) * batch * task.horizon
    with TerminalListener(f"playing {episodes} episodes") as listener:

        def tell(env_steps: int) -> None:
            listener.expect(steps, after="summing up")
            listener.advance(env_steps)

        yield watched(task, tell, PATIENCE)
