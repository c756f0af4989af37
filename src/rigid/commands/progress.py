"""Progress on the terminal: an estimate before the start, a bar with time left, and plain lines.

Everything goes to standard error, so that `--json` leaves standard output to the result.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, final

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TaskID, TextColumn
from rich.progress import Task as Bar
from rich.table import Column
from rich.text import Text

from rigid.commands.parsing import spoken

if TYPE_CHECKING:
    from rigid.tasks.protocol import Task

SCORING = "scoring"
PATIENCE = 2.0
"""Seconds after which people want to see that something moves. Ours."""
_MEMORY = 120.0
"""Seconds over which the speed is taken. Ours: one iteration of a slow task may take a minute."""


@final
class TimeColumn(ProgressColumn):
    """How long it has taken, and how long it will take: two times that cannot be mixed up."""

    max_refresh = 0.5

    def __init__(self, after: str) -> None:
        """Says `after` once the bar is full: what is done then."""
        super().__init__(Column(no_wrap=True))  # The bar gives way on a narrow terminal.
        self.after = after
        self.expected: float | None = None
        """Seconds that the whole should take, for as long as nothing was seen of it."""

    def render(self, task: Bar) -> Text:
        """The times of one bar."""
        elapsed = task.finished_time if task.finished else task.elapsed
        return Text(f"{clock(elapsed or 0.0)} so far{self._rest(task, elapsed or 0.0)}")

    def _rest(self, task: Bar, elapsed: float) -> str:
        if task.finished:
            return f" · {self.after}"
        left = task.time_remaining
        if left is None and self.expected is not None:
            left = self.expected - elapsed
        if left is None:
            return ""
        return f" · {spoken(left)} left" if left > 0 else " · longer than expected"


def clock(seconds: float) -> str:
    """A time as a watch shows it.

    Example:
        >>> clock(75), clock(3700)
        ('1:15', '1:01:40')
    """
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def bar_of(console: Console, *columns: ProgressColumn) -> Progress:
    """A bar with a description, and `columns` after it."""
    shown = (TextColumn("{task.description}"), BarColumn(), *columns)
    return Progress(*shown, console=console, speed_estimate_period=_MEMORY)


@final
class TerminalListener:
    """Tells the terminal how a measurement goes on; use as a context manager.

    A listener that shows something else holds one and passes on what it wants shown.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._console = Console(stderr=True)
        self._times = TimeColumn(SCORING)
        self._bar = bar_of(self._console, TextColumn("{task.percentage:>3.0f} %"), self._times)
        self._task: TaskID | None = None

    def __enter__(self) -> TerminalListener:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._task is not None:  # One that never began leaves no empty line.
            self._bar.stop()

    def begin(self, env_steps: int, seconds: float) -> None:
        """Training starts."""
        self.say(
            f"{env_steps:,} training steps; about {spoken(seconds)} at the speed just measured"
        )
        self._times.expected = seconds
        self.expect(env_steps)

    def expect(self, env_steps: int, after: str = SCORING) -> None:
        """Steps that the bar stands for, from now on, and what is done after the last."""
        self._times.after = after
        if self._task is not None:
            self._bar.update(self._task, total=env_steps)
            return
        self._task = self._bar.add_task(self._what, total=env_steps)
        self._bar.start()

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call."""
        if self._task is None:
            return
        before = self._bar.tasks[0].percentage
        self._bar.advance(self._task, env_steps)
        now = self._bar.tasks[0].percentage
        # A bar does not show in a log.
        if not self._console.is_terminal and now // 5 > before // 5:
            self.say(f"{self._what}: {now:.0f} %")

    def say(self, text: str) -> None:
        """A line for the user."""
        self._console.print(text, highlight=False, markup=False)


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
