"""How much time a measurement has taken, earlier sessions of an interrupted one included."""

from __future__ import annotations

import json
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rigid.cores import helper_seconds
from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically

_EVERY = 5.0
"""Seconds between two notes: at most this much of a killed session goes uncounted."""


class Clock:
    """Wall time since the clock was made, and the time that its measurement took of processors.

    Processor time is that of this process and its children while they work for the measurement, and
    what workers elsewhere report: of several measurements under way, each counts its own. The
    driver's time is the wall time for which this process worked for it, and so for no other.
    """

    def __init__(self) -> None:
        self._wall, self._core, self._driver = time.perf_counter(), 0.0, 0.0
        self._since: tuple[float, float] | None = None
        self._earlier = {"core_seconds": 0.0, "wall_seconds": 0.0, "driver_seconds": 0.0}
        self._note: Path | None = None
        self._noted = self._wall

    def go_on(self, note: Path) -> None:
        """Adds what earlier sessions left in `note`, and leaves its own there from now on.

        Raises:
            UserError: The note is damaged.
        """
        self._note = note
        if not note.exists():
            return
        cure = "delete it; only the times before are lost"
        try:
            stored = json.loads(read_bytes(note, cure=cure))
            stored.setdefault("driver_seconds", 0.0)  # Notes of before it was counted.
            self._earlier = {name: float(stored[name]) for name in self._earlier}
        except (ValueError, KeyError, TypeError, AttributeError):
            raise UserError(f"{note} is damaged: {cure}") from None

    @contextmanager
    def working(self) -> Iterator[None]:
        """Counts the processor time that passes inside, and that the driver was busy."""
        self._since = core_seconds(), time.perf_counter()
        try:
            yield
        finally:
            self._core, self._driver = self._spent()
            self._since = None

    def add(self, seconds: float) -> None:
        """Counts what a worker in another process took [s]."""
        self._core += seconds

    def tick(self) -> None:
        """Notes the time now and then."""
        if time.perf_counter() - self._noted >= _EVERY:
            self.keep()

    def keep(self) -> None:
        """Notes the time for later sessions."""
        if self._note is not None:
            self._note.parent.mkdir(exist_ok=True)
            write_atomically(self._note, json_text(self.read()).encode())
            self._noted = time.perf_counter()

    def read(self) -> dict[str, float]:
        """Time spent in all sessions so far [s]."""
        core, driver = self._spent()
        wall = time.perf_counter() - self._wall
        now = {"core_seconds": core, "wall_seconds": wall, "driver_seconds": driver}
        return {name: round(self._earlier[name] + spent, 1) for name, spent in now.items()}

    def _spent(self) -> tuple[float, float]:
        """Processor time and the driver's, up to now [s]."""
        if self._since is None:
            return self._core, self._driver
        core, wall = self._since
        return (
            self._core + core_seconds() - core,
            self._driver + time.perf_counter() - wall,
        )


def core_seconds() -> float:
    """Processor time so far of this process, its ended children and its living helpers [s]."""
    usages = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return helper_seconds() + sum(usage.ru_utime + usage.ru_stime for usage in usages)
