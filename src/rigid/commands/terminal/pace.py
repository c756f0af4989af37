"""How long work will still take: an expectation first, then what is seen of it."""

from __future__ import annotations

import time
from collections.abc import Callable

_TRUST = 20.0
"""Seconds of work for which the expected speed counts, beside those that were seen. Ours: without
it the first few steps decide, and the estimate jumps."""


class Pace:
    """The speed of steps.

    What passes before the first step is no sign of the speed: it is spent on compilation.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        """Time runs from now on.

        Args:
            now: The time [s], from any start.
        """
        self._now, self._begun = now, now()
        self._speed: float | None = None
        self._starting = 0.0
        self._since: float | None = None
        self._last = 0.0
        self._steps = 0

    @property
    def expected(self) -> bool:
        """Whether a speed is expected."""
        return self._speed is not None

    @property
    def compiling(self) -> bool:
        """Whether steps are still to begin."""
        return self._starting > 0 and self._since is None

    def expect(self, steps_per_second: float, starting: float = 0.0) -> None:
        """What is expected before anything is seen: a speed, and the time until it begins [s]."""
        self._speed, self._starting, self._begun = steps_per_second, starting, self._now()

    def advance(self, steps: int) -> None:
        """Steps that were done since the last call."""
        self._last = self._now()
        if self._since is None:
            self._since = self._last
        else:
            self._steps += steps

    def left(self, steps: float) -> float | None:
        """Time for so many steps [s]; None where nothing is known.

        Between two steps it does not grow: they may come in groups.
        """
        if self._since is None:
            if self._speed is None:
                return None
            return max(self._starting - (self._now() - self._begun), 0.0) + steps / self._speed
        trust = 0.0 if self._speed is None else _TRUST
        seen = self._steps + trust * (self._speed or 0.0)
        return steps * (trust + self._last - self._since) / seen if seen else None
