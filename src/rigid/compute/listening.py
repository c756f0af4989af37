"""Who is told how a measurement goes on."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


@runtime_checkable
class Listener(Protocol):
    """Who is told how a measurement goes on; the command line draws a progress bar."""

    def begin(self, env_steps: int, seconds: float) -> None:
        """Training starts: total steps, and an estimate of the time it will take."""
        ...

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call, resumed ones included."""
        ...

    def say(self, text: str) -> None:
        """A line for the user."""
        ...


class Silence:
    """A listener that says nothing."""

    def begin(self, env_steps: int, seconds: float) -> None:
        """Ignored."""

    def advance(self, env_steps: int) -> None:
        """Ignored."""

    def say(self, text: str) -> None:
        """Ignored."""
