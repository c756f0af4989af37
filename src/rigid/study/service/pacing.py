"""When each control step is due: no drift, and no bursts to make up for lost time."""

from __future__ import annotations

CATCH_UP = 0.1
"""Share of a period by which a step may come closer to the late one before it. Ours: the hand of a
participant then feels steps of 90 to 110 ms, never two at once."""


class Schedule:
    """Steps are due at start, start + period, start + 2 periods and so on.

    A late step does not move the ones after it, unless they would follow too soon: then delay is
    worked off by `CATCH_UP` of a period a step. Delay of a whole period or more is given up: those
    times are past, and the steps go on from now.
    """

    def __init__(self, period: float, start: float) -> None:
        """Periods and times in seconds, on a clock that never goes back."""
        self._period, self._planned, self.due = period, start, start

    def began(self, now: float) -> None:
        """A step begins; sets `due` to when the next one should.

        Example:
            >>> schedule = Schedule(0.1, start=0.0)
            >>> schedule.began(0.03)  # 30 ms late
            >>> round(schedule.due, 3)
            0.12
            >>> schedule.began(0.12)
            >>> round(schedule.due, 3)
            0.21
        """
        if now - self._planned >= self._period:
            self._planned = now
        self._planned += self._period
        self.due = max(self._planned, now + (1 - CATCH_UP) * self._period)
