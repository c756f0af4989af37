"""Who is told how a measurement goes on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable


@dataclass(frozen=True, kw_only=True)
class Workload:
    """What lies ahead when a measurement begins, or goes on."""

    training_steps: int
    """Environment steps of all training, whoever does or did it."""
    steps: int
    """Those of scoring as well: what `Listener.advance` comes to, with `done`."""
    done: int = 0
    """Of `steps`, those that earlier calls did."""
    steps_per_second: float
    """Expected speed."""
    starting: float = 0.0
    """Expected time before the first step is done [s]: compilation."""

    @property
    def seconds(self) -> float:
        """Expected time for what is left [s]."""
        return self.starting + (self.steps - self.done) / self.steps_per_second


@runtime_checkable
class Listener(Protocol):
    """Who is told how a measurement goes on; the command line draws a progress bar."""

    def begin(self, work: Workload) -> None:
        """Work starts."""
        ...

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call, of training and scoring; none of earlier calls."""
        ...

    def say(self, text: str) -> None:
        """A line for the user."""
        ...


class Silence:
    """A listener that says nothing."""

    def begin(self, work: Workload) -> None:
        """Ignored."""

    def advance(self, env_steps: int) -> None:
        """Ignored."""

    def say(self, text: str) -> None:
        """Ignored."""
