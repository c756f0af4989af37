"""`rigid gate`: a robot against a limit, or against another robot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import tyro

from rigid.commands.measured import load_measured
from rigid.commands.parsing import printable
from rigid.commands.terminal.wrapping import NO_BREAK, columns, wrapped
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.frontier.comparison import Number

_shown_as = tyro.conf.arg
GATE_FAILED = 3
_FEW = 5
"""Search seeds below which a note warns of a gate that opens (ours): with 3, intervals of
`worst_at` cover 90 to 92 % (results/coverage), and 2 that agree by chance have a narrow one."""
_WHY_WIDER = (
    "upper bounds: 95 % over search seeds; of t and t of the logit the larger, since t alone "
    "promises too much where seeds are skewed towards 0"
)
_MORE_SEEDS = (
    "more search seeds narrow a bound: `rigid frontier` with the same --out and more --seeds adds "
    "them"
)


@dataclass(frozen=True)
class GateCommand:
    """Exit with 3 unless a robot is robust enough, by upper bounds over search seeds.

    The bound of a number is the upper end of its 95 % t interval or of that on the logit scale,
    whichever is larger: where seeds are skewed towards 0, t alone promises too much. That of a
    difference is the upper end of the paired t interval, which for `worst at` covered only 76 to
    87 % in whole searches of an analytic task. No bound knows of what no seed found.

    Examples:
      rigid gate runs/mine --max-worst 0.4 --at-naturalness 0.9
      rigid gate runs/mine --baseline runs/last-release --margin 0.05
    """

    directory: Annotated[Path, tyro.conf.Positional]
    """A finished run directory."""
    max_worst: Annotated[float | None, _shown_as(metavar="Y")] = None
    """Largest allowed worst adversarialness at --at-naturalness."""
    at_naturalness: float = 0.9
    """From which naturalness on --max-worst and --baseline look."""
    max_auc: Annotated[float | None, _shown_as(metavar="AUC")] = None
    """Largest allowed area under the frontier."""
    max_auc_natural: Annotated[float | None, _shown_as(metavar="Y")] = None
    """Largest allowed mean height of the frontier over naturalness [0.8, 1]."""
    baseline: Annotated[Path | None, _shown_as(metavar="DIR")] = None
    """A measurement that this one may not be worse than, paired by search seed: neither its worst
    at --at-naturalness nor its mean over [0.8, 1]."""
    margin: float = 0.0
    """By how much it may be worse than the baseline."""

    def run(self) -> int:
        """Prints a verdict for each limit; 3 when one is exceeded."""
        if not 0 <= self.at_naturalness <= 1:
            raise UserError(f"--at-naturalness is {self.at_naturalness}, but must lie in [0, 1]")
        verdicts = [*_absolute(self), *_against_baseline(self)]
        if not verdicts:
            raise UserError("name a limit: --max-worst, --max-auc-natural, --max-auc or --baseline")
        width = columns()
        for one in verdicts:
            sign = "ok    " if one.fine else "FAILED"
            print(wrapped(f"{sign}  {one.text}", width, hanging=" " * len("FAILED  ")))
        for note in _notes(self, verdicts):
            print(wrapped(note, width))
        return 0 if all(one.fine for one in verdicts) else GATE_FAILED


class _Verdict(NamedTuple):
    fine: bool
    text: str
    undecided: bool = False
    """Whether the mean keeps the limit that its bound does not."""


def _notes(options: GateCommand, verdicts: Sequence[_Verdict]) -> Iterator[str]:
    """What a reader of the verdicts has to know, a sentence each."""
    named = filter(None, (options.directory, options.baseline))
    frontiers = {directory: load_measured(directory)[0] for directory in named}
    limits = options.max_worst, options.max_auc_natural, options.max_auc
    if any(limit is not None for limit in limits):
        yield _WHY_WIDER
        seeds = len(frontiers[options.directory].data["auc_by_seed"])
        if seeds < _FEW and any(one.fine for one in verdicts):
            yield (
                f"{seeds} search seeds may agree by chance, and let a robot pass by luck: rely on "
                f"{_FEW} or more"
            )
    if any(one.undecided for one in verdicts):
        yield _MORE_SEEDS
    if (options.max_worst, options.baseline) == (None, None):
        return
    for directory, frontier in frontiers.items():
        lacking = frontier.lacking_at(options.at_naturalness)
        if lacking is not None:
            yield f"{printable(str(directory))}: {lacking}"


def _absolute(options: GateCommand) -> Iterator[_Verdict]:
    from rigid.frontier.comparison import numbers_of
    from rigid.frontier.standings import TITLES

    numbers = numbers_of(load_measured(options.directory)[0], options.at_naturalness)
    level = f"worst at naturalness ≥ {options.at_naturalness:g}"
    for limit, key, label in (
        (options.max_worst, "worst_at", level),
        (options.max_auc_natural, "auc_natural", TITLES["auc_natural"]),
        (options.max_auc, "auc", "AUC"),
    ):
        if limit is not None:
            yield _within(label, numbers[key].mean, *_bound(numbers[key]), limit)


def _against_baseline(options: GateCommand) -> Iterator[_Verdict]:
    from rigid.frontier.comparison import compare
    from rigid.frontier.standings import TITLES

    if options.baseline is None:
        return
    frontiers, identities = {}, {}
    for name, directory in (("baseline", options.baseline), ("robot", options.directory)):
        frontiers[name], identities[name] = load_measured(directory)
    against = compare(frontiers, identities, level=options.at_naturalness)[1].against
    assert against is not None
    level = f"worst at ≥ {options.at_naturalness:g}"
    for key, label in (("worst_at", level), ("auc_natural", TITLES["auc_natural"])):
        found = against[key]
        high = None if found.interval is None else found.interval.high
        yield _within(f"{label} minus baseline", found.mean, high, "paired t", options.margin)


def _bound(number: Number) -> tuple[float | None, str]:
    """The upper bound of a number, None for one seed, and where it comes from."""
    bound, interval = number.upper_bound, number.interval
    if bound is None or interval is None:
        return None, ""
    return bound, "t" if bound <= interval.high else f"t of the logit; t: {interval.high:.3f}"


def _within(label: str, mean: float, bound: float | None, source: str, limit: float) -> _Verdict:
    """Whether the upper bound keeps the limit; without one nothing is known."""
    if bound is None:
        text = f"{label}: {mean:.3f} from one seed has no upper bound; add --seeds"
        return _Verdict(fine=False, text=text)
    held = source.replace(" ", NO_BREAK)
    text = f"{label}: {mean:.3f}, upper bound {bound:.3f}, limit {limit:g} ({held})"
    return _Verdict(bound <= limit, text, undecided=mean <= limit < bound)
