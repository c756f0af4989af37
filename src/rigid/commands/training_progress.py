"""How the progress of a training is shown."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isnan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigid.learning.cooptimisation import Progress


@contextmanager
def show_progress(what: str, iterations: int) -> Iterator[Callable[[Progress], None]]:
    """A progress bar over iterations with the newest return and success."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import (
        Progress as Bar,
    )

    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(),
        TextColumn("left"), TimeRemainingColumn(),
    )  # fmt: skip
    console = Console(stderr=True)
    with Bar(*columns, console=console) as bar:
        task = bar.add_task(what, total=iterations)

        def report(progress: Progress) -> None:
            seen = f"return {progress.mean_return:.1f}"
            if not isnan(progress.success):  # Of a task that defines none.
                seen += f" · success {progress.success:.2f}"
            done = progress.iteration + 1
            bar.update(task, completed=done, description=f"{what} · {seen}")
            if not console.is_terminal and done % 10 == 0:  # A bar does not show in a log.
                console.print(f"{what} {done}/{iterations} · {seen}", highlight=False)

        yield report
