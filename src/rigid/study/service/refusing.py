"""What the service refuses: said to whoever sent it, counted for whoever runs the study."""

from __future__ import annotations

from collections import Counter
from typing import Final

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

    def unkept(self) -> dict[str, int]:
        """What was counted since the last call, for the store.

        Example:
            >>> refusals = Refusals()
            >>> refusals.count("live", "replayed")
            >>> refusals.unkept(), refusals.unkept()
            ({'live:replayed': 1}, {})
        """
        new = self._counts - self._kept
        self._kept = self._counts.copy()
        return dict(new)
