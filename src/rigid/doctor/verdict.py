"""What a step of the examination says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

Status = Literal["pass", "warn", "fail", "skip"]

TITLES = {
    "protocol": "The task keeps its protocol",
    "features": "Key features vary",
    "reward": "The human can influence the reward",
    "data": "Enough canonical data",
    "ends": "λ = 0 breaks the task, λ = ∞ stays canonical",
    "scan": "A first scan over λ",
}
"""Steps in their order: the paper's four, with the task before them and the reward, which the paper
takes for granted, as a step of its own. Ours."""


@dataclass(frozen=True)
class Verdict:
    """One step: what it found, and what to do about it."""

    step: str
    """One of `TITLES`."""
    status: Status
    """A `warn` leaves the numbers usable, with care; after a `skip` the step is unknown."""
    says: str
    """One sentence in plain words."""
    advice: str = ""
    """What to do; empty where there is nothing."""
    evidence: Mapping[str, Any] = field(default_factory=dict)
    """Numbers as JSON; the page draws them."""

    @property
    def title(self) -> str:
        """The step in words."""
        return TITLES[self.step]

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "step": self.step, "title": self.title, "status": self.status, "says": self.says,
            "advice": self.advice, "evidence": dict(self.evidence),
        }  # fmt: skip


def skipped(step: str, why: str) -> Verdict:
    """A step that could not be taken."""
    return Verdict(step, "skip", f"Not examined: {why}.")


def listed(names: Sequence[str], most: int = 4) -> str:
    """Some names, so that a sentence stays one.

    Example:
        >>> listed(["a", "b"]), listed(["a", "b", "c", "d", "e", "f"])
        ('a, b', 'a, b, c, d and 2 others')
    """
    if len(names) <= most + 1:
        return ", ".join(names)
    return f"{', '.join(names[:most])} and {len(names) - most} others"
