"""Progress on the terminal: an estimate before the start, a bar with time left, and plain lines.

Everything goes to standard error, so that `--json` leaves standard output to the result.
"""

from __future__ import annotations

from types import TracebackType
from typing import final

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    TaskID,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from rigid.commands.parsing import spoken


@final
class TerminalListener:
    """Tells the terminal how a measurement goes on; use as a context manager.

    A listener that shows something else holds one and passes on what it wants shown.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._console = Console(stderr=True)
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=self._console,
        )
        self._task: TaskID | None = None

    def __enter__(self) -> TerminalListener:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._bar.stop()

    def begin(self, env_steps: int, seconds: float) -> None:
        """Training starts."""
        self.say(
            f"{env_steps:,} training steps; about {spoken(seconds)} at the speed just measured"
        )
        self.expect(env_steps)

    def expect(self, env_steps: int) -> None:
        """Steps that the bar stands for, from now on."""
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
