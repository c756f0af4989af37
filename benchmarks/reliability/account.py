"""The account: a text filled from the tables, so that they cannot disagree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.reliability.plan import LIMIT_SHARE, LIMITS, NUMBERS, Plan
from benchmarks.reliability.spread import Measured, Row, Spread, share_within

_TEMPLATE = Path(__file__).with_name("account.md")


def write_account(
    path: Path,
    plan: Plan,
    spreads: Mapping[str, Spread],
    measured: Sequence[Measured],
    pairs: Sequence[Row],
) -> None:
    """Writes the README of the results.

    Args:
        path: Its file.
        plan: The study.
        spreads: Of each headline number.
        measured: The headline numbers of each measurement.
        pairs: From `spread.pair_rows`.
    """
    preset = plan.preset
    text = _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=plan.stamp, command=plan.command, robot=plan.robot, task=plan.task.name,
        measurements=len(measured), pairs=len(pairs) // len(NUMBERS), seeds=len(preset.seeds),
        last=len(preset.seeds) - 1, preset=preset.name, share=LIMIT_SHARE,
        limits=" and ".join(f"{limit} in `{name}`" for name, limit in LIMITS.items()),
        criterion=criterion(pairs),
        spreads="\n".join(_spread_line(name, spreads[name], pairs) for name in NUMBERS),
        printed="\n".join(
            f"| `{name}` | {spreads[name].printed:.3f} | {spreads[name].held:.0%} |"
            for name in NUMBERS
        ),
        verdicts="\n".join(f"- {verdict(name, spreads[name])}" for name in NUMBERS),
        per_round=" + ".join(str(number) for number in preset.per_round),
        iterations=preset.iterations, episodes=preset.episodes, scoring=preset.scoring_episodes,
        search=preset.search_canonical, referee=3 * preset.referee_canonical,
        heads=" | ".join(f"`{name}`" for name in NUMBERS),
        measured="\n".join(
            _measured_line(place, numbers) for place, numbers in enumerate(measured, start=1)
        ),
    )  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def criterion(pairs: Sequence[Row]) -> str:
    """Whether enough pairs keep each limit."""
    kept = {name: share_within(pairs, name) >= LIMIT_SHARE for name in LIMITS}
    parts = [f"`{name}` {'keeps' if fine else 'does not keep'} it" for name, fine in kept.items()]
    return f"{', '.join(parts)}."


def verdict(name: str, spread: Spread) -> str:
    """What the ratio says of the printed reliability."""
    if spread.ratio is None or spread.low is None or spread.high is None:
        return f"`{name}`: seeds do not differ at all, so that they predict nothing."
    ratio = f"{spread.ratio:.2f} [{spread.low:.2f}, {spread.high:.2f}]"
    if spread.low > 1:
        return (
            f"`{name}`: measurements differ more than their seeds say, by a factor of {ratio}. "
            f"Canonical data and referees add a deviation of {spread.added:.3f} that no interval "
            "over seeds can know: the printed reliability promises too much."
        )
    if spread.high < 1:
        return (
            f"`{name}`: measurements differ less than their seeds say, by a factor of {ratio}: "
            "the printed reliability promises too little."
        )
    return (
        f"`{name}`: measured and predicted spread cannot be told apart; their ratio is {ratio}, so "
        f"that a factor of {spread.high:.1f} is not excluded."
    )


def _spread_line(name: str, spread: Spread, pairs: Sequence[Row]) -> str:
    within = f"{share_within(pairs, name):.0%}" if name in LIMITS else "no limit"
    largest = max(abs(row["difference"]) for row in pairs if row["number"] == name)
    ratio = "unknown"
    if spread.ratio is not None:
        ratio = f"{spread.ratio:.2f} [{spread.low:.2f}, {spread.high:.2f}]"
    return (
        f"| `{name}` | {spread.mean:.3f} | {within} | {largest:.3f} | {spread.measured:.4f} "
        f"| {spread.predicted:.4f} | {ratio} | {spread.added:.4f} |"
    )


def _measured_line(place: int, numbers: Measured) -> str:
    cells = []
    for name in NUMBERS:
        ends = numbers[name].interval
        bracket = "" if ends is None else f" [{ends.low:.3f}, {ends.high:.3f}]"
        cells.append(f"{numbers[name].mean:.3f}{bracket}")
    seeds = sorted(map(int, numbers[NUMBERS[0]].by_seed))
    return f"| {place} | {seeds[0]} to {seeds[-1]} | {' | '.join(cells)} |"
