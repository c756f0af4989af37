"""What the service refuses: said to whoever sent it, counted for whoever runs the study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Awaitable, Callable
from typing import Final

from rigid.errors import UserError

STATUS_OF_CODE: Final = {
    "malformed": 400,
    "invalid": 400,
    "unknown-token": 401,
    "forbidden": 403,
    "not-found": 404,
    "method": 405,
    "too-slow": 408,
    "not-now": 409,
    "too-large": 413,
    "not-json": 415,
    "too-many": 429,
    "unavailable": 503,
}
"""Every code that an answer may carry, and its HTTP status."""


class Refusal(Exception):  # noqa: N818 - no error of the program: the answer to a message.
    """The answer to a message that has no effect."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code, self.message = code, message

    @property
    def status(self) -> int:
        """Of HTTP."""
        return STATUS_OF_CODE[self.code]


class Refusals:
    """How many messages were refused, by where and why, since the server started."""

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._kept: Counter[str] = Counter()

    def count(self, where: str, code: str) -> None:
        """One more; `where` is the door it came to, such as `http`, `live` or `admin`."""
        self._counts[f"{where}:{code}"] += 1

    def by_reason(self) -> dict[str, int]:
        """Counts by `where:code`, most first."""
        return dict(self._counts.most_common())

    async def keep(self, write: Callable[[str, int], Awaitable[None]]) -> None:
        """Has written down what was counted since it last was.

        Args:
            write: Takes `where:code` and how many more; what it refuses is written the next time.

        Example:
            >>> import asyncio
            >>> refusals, written = Refusals(), []
            >>> async def write(reason, count):
            ...     written.append((reason, count))
            >>> refusals.count("live", "replayed")
            >>> asyncio.run(refusals.keep(write)), asyncio.run(refusals.keep(write)), written
            (None, None, [('live:replayed', 1)])
        """
        for reason in tuple(self._counts):
            # Looked at anew each time: somebody else may have it written while this one waits.
            count = self._counts[reason] - self._kept[reason]
            if not count:
                continue
            # Before it is written: a write goes on to its end when nobody waits for it any more.
            self._kept[reason] += count
            try:
                await write(reason, count)
            except UserError:
                self._kept[reason] -= count
                raise
