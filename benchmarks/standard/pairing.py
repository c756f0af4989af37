"""Both presets on the same robot and search seed: values in pairs, and rows of differences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from benchmarks.paired import BySeed, Row, compared
from benchmarks.standard.plan import DECIDING
from rigid.frontier.comparison import numbers_of
from rigid.frontier.result import Frontier

NUMBERS = (*DECIDING, "worst_at_0.8", "worst_at_0.9", "hull_at_0.9")
POOLED = "all robots"


Measured = Mapping[str, Mapping[int, Frontier]]
"""Complete measurements of a robot by preset and search seed, each of that seed alone."""


@dataclass(frozen=True)
class Pairs:
    """One number of one robot with both presets, on the seeds that both have."""

    robot: str
    number: str
    standard: BySeed
    paper: BySeed

    @property
    def seeds(self) -> list[int]:
        """Search seeds, ascending."""
        return list(self.standard)

    @property
    def differences(self) -> list[float]:
        """`standard` - `paper`, by seed."""
        return [self.standard[seed] - self.paper[seed] for seed in self.seeds]


def pairs_of(robot: str, measured: Measured) -> list[Pairs]:
    """Every number of a robot.

    Args:
        robot: Its name.
        measured: What is there of it; without one of the presets there are no pairs.
    """
    standard, paper = (values(measured.get(preset, {})) for preset in ("standard", "paper"))
    return [on_common_seeds(robot, number, standard[number], paper[number]) for number in NUMBERS]


def on_common_seeds(robot: str, number: str, standard: BySeed, paper: BySeed) -> Pairs:
    """The values of common seeds, whatever their order.

    Example:
        >>> pairs = on_common_seeds("a", "auc", {1: 0.5, 0: 0.4}, {0: 0.4, 1: 0.25, 2: 0.9})
        >>> pairs.seeds, pairs.differences
        ([0, 1], [0.0, 0.25])
    """
    seeds = sorted(set(standard) & set(paper))
    return Pairs(
        robot,
        number,
        {seed: standard[seed] for seed in seeds},
        {seed: paper[seed] for seed in seeds},
    )


def pooled(pairs: Sequence[Pairs]) -> Pairs:
    """Means over robots, on the seeds that all of them have.

    The seed stays the unit: what it finds is alike for all robots, so that their pairs are no
    independent ones. Ours.

    Args:
        pairs: The same number of each robot.
    """
    seeds = sorted(set.intersection(*(set(one.seeds) for one in pairs)))
    return Pairs(
        POOLED, pairs[0].number,
        {seed: fmean(one.standard[seed] for one in pairs) for seed in seeds},
        {seed: fmean(one.paper[seed] for one in pairs) for seed in seeds},
    )  # fmt: skip


def with_pooled(pairs: Sequence[Pairs]) -> list[Pairs]:
    """The pairs of all robots, then those of their means."""
    return [*pairs, *(pooled([p for p in pairs if p.number == number]) for number in NUMBERS)]


def table_rows(pairs: Sequence[Pairs]) -> list[Row]:
    """A row for each: both means, and the paired difference with its 95 % t interval."""
    return [_row(one) for one in pairs]


def seed_rows(pairs: Sequence[Pairs]) -> list[Row]:
    """A row for each pair of each number."""
    return [
        {
            "robot": one.robot, "number": one.number, "seed": seed,
            "standard": one.standard[seed], "paper": one.paper[seed],
        }
        for one in pairs for seed in one.seeds
    ]  # fmt: skip


def _row(pairs: Pairs) -> Row:
    found = compared({}, pairs.number, pairs.standard, theirs=pairs.paper)
    return {
        "robot": pairs.robot,
        "number": pairs.number,
        "standard": found["value"],
        "paper": fmean(pairs.paper.values()) if pairs.paper else None,
        **{key: found[key] for key in ("difference", "difference_low", "difference_high", "seeds")},
    }


def values(frontiers: Mapping[int, Frontier]) -> dict[str, BySeed]:
    """Every number by seed, of measurements of a seed each."""
    found: dict[str, dict[int, float]] = {number: {} for number in NUMBERS}
    for seed, frontier in frontiers.items():
        low, high = numbers_of(frontier, 0.8), numbers_of(frontier, 0.9)
        numbers = {
            "auc": high["auc"],
            "auc_natural": high["auc_natural"],
            "worst_at_0.8": low["worst_at"],
            "worst_at_0.9": high["worst_at"],
            "hull_at_0.9": high["hull_at"],
        }
        for name, number in numbers.items():
            found[name][seed] = number.by_seed[str(seed)]
    return dict(found)
