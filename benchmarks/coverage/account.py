"""The account: a text filled from the table, so that the two cannot disagree."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.coverage.ends import INTERVALS
from benchmarks.coverage.plan import PLAUSIBLE, QUICK, Plan
from benchmarks.coverage.searching import HULL, NUMBERS
from benchmarks.coverage.tables import BCA, CHECK, PRINTED, UNPAIRED, Row
from benchmarks.paired import find, markdown
from rigid.frontier.comparison import HEADLINE_LEVEL

_TEMPLATE = Path(__file__).with_name("account.md")


def write_account(
    path: Path, plan: Plan, population: Sequence[Mapping[str, Any]], rows: Sequence[Row]
) -> None:
    """Writes the README of the results.

    Args:
        path: Its file.
        plan: The study.
        population: From `searching.population`.
        rows: Of the table.
    """
    searches, laws = (
        [row for row in rows if row["source"] == kind] for kind in ("searches", "law")
    )
    headline = [row for row in searches if not row["quantity"].startswith(HULL)]
    preset = plan.preset
    text = _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=plan.stamp,
        command=f"python -m benchmarks.coverage{' --quick' if plan is QUICK else ''}",
        sizes=listed([str(size) for size in plan.sizes]),
        seeds=len(preset.seeds), level=HEADLINE_LEVEL,
        searches_verdict=verdict(_sized(headline, PRINTED, plan.sizes)),
        searches=_covers(headline, PRINTED, plan.sizes),
        laws_verdict=verdict(_sized(laws, PRINTED, plan.sizes)),
        laws=_covers(laws, PRINTED, plan.sizes),
        why=why(_sized(rows, PRINTED, plan.sizes)),
        bca_size=plan.bca_size,
        bca_verdict=verdict([row for row in rows if row["interval"] == BCA]),
        bca=_bca(rows, plan.bca_size),
        jumps=jumps(population, plan.tolerances),
        differences=_differences(searches, plan.sizes),
        better=better_difference(searches, plan.sizes),
        rivals=_rivals(rows, plan.shown),
        rivals_verdict=_rivals_verdict(rows, plan.sizes),
        absent=_shares(plan, lambda n: 0.9**n),
        excluded=_shares(plan, lambda n: 1 - 0.025 ** (1 / n)),
        tolerances=listed([f"{one:g}" for one in plan.tolerances]),
        lambdas=sum(preset.per_round), lambda_min=preset.lambda_min, lambda_max=preset.lambda_max,
        iterations=preset.iterations, episodes=preset.episodes, referee=preset.referee_episodes,
        validation=preset.validation_episodes, scoring=preset.scoring_episodes,
        draws=plan.draws, redraws=plan.redraws, bca_draws=plan.bca_draws,
        check=_largest_check(searches),
        error_low=min(row["error_results"] for row in _sized(searches, PRINTED, plan.sizes)),
        error_high=max(row["error_results"] for row in _sized(searches, PRINTED, plan.sizes)),
        error=(0.95 * 0.05 / plan.draws) ** 0.5,
    )  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def verdict(rows: Sequence[Row]) -> str:
    """In how many cases the cover is plausible, its range, and which cases leave it."""
    outside = [row for row in rows if row["leaves_92_98"]]
    low, high = (f"{100 * bound:.0f}" for bound in PLAUSIBLE)
    covers = [row["cover"] for row in rows]
    text = f"covers of {min(covers):.3f} to {max(covers):.3f}; "
    if not outside:
        return f"{text}all {len(rows)} cases lie within {low} to {high} %."
    names = list(dict.fromkeys(row["quantity"] for row in outside))
    cases = [
        f"{name} (n = {', '.join(str(row['n']) for row in outside if row['quantity'] == name)})"
        for name in names
    ]
    return f"{text}{len(outside)} of {len(rows)} cases leave {low} to {high} %: {'; '.join(cases)}."


def why(rows: Sequence[Row]) -> str:
    """To which side the interval misses where it covers too little."""
    short = [row for row in rows if row["cover"] < PLAUSIBLE[0]]
    if not short:
        return "No case covers less than 92 %."
    upward = [row for row in short if row["truth_above"] > row["truth_below"]]
    text = (
        f"In {len(upward)} of the {len(short)} cases that cover less than 92 % the truth lies "
        "above the interval more often than below it."
    )
    if 2 * len(upward) > len(short):
        text += (
            " Seeds that miss the long upper tail have a low mean and a small spread at once: the "
            "interval is too low and too narrow together. So it is the *upper* end, the one that "
            "`rigid gate` holds against a limit, that promises too much."
        )
    return text


def jumps(population: Sequence[Mapping[str, Any]], tolerances: tuple[float, float]) -> str:
    """Differences of `worst_at` where it has the same λ with both robots, and elsewhere."""
    first, second = (
        {row["seed"]: row for row in population if row["tolerance"] == tolerance}
        for tolerance in tolerances
    )
    groups: dict[bool, list[float]] = {True: [], False: []}
    for seed, row in first.items():
        same = row["worst_lambda"] == second[seed]["worst_lambda"]
        groups[same].append(row["worst_at"] - second[seed]["worst_at"])
    return (
        f"On {_spoken(groups[True])} it comes from the same λ with both robots; on "
        f"{_spoken(groups[False])} from another."
    )


def _spoken(differences: Sequence[float]) -> str:
    count = f"{len(differences)} seeds"
    if len(differences) < 2:
        return count
    deviation = np.std(differences, ddof=1)
    return f"{count} (difference {np.mean(differences):.3f}, deviation {deviation:.3f})"


def listed(words: Sequence[str]) -> str:
    """Words in a sentence.

    Example:
        >>> listed(["3", "5", "8"]), listed(["3"])
        ('3, 5 and 8', '3')
    """
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _sized(rows: Sequence[Row], interval: str, sizes: Sequence[int]) -> list[Row]:
    return [row for row in rows if row["interval"] == interval and row["n"] in sizes]


def _covers(rows: Sequence[Row], interval: str, sizes: Sequence[int]) -> str:
    """A line for each quantity: its skewness and its cover at each size."""
    heads = ["", "skewness", *(f"n = {size}" for size in sizes), f"truth above, n = {sizes[-1]}"]
    lines = []
    for name in dict.fromkeys(row["quantity"] for row in rows):
        mine = [find(rows, quantity=name, interval=interval, n=size) for size in sizes]
        covers = [_cover(row) for row in mine]
        last = f"{mine[-1]['truth_above']:.3f}"
        skewness = mine[0]["skewness"]
        skewed = "–" if skewness is None else f"{skewness:.1f}"
        lines.append([f"`{name}`", skewed, *covers, last])
    return markdown(heads, lines)


def _cover(row: Row) -> str:
    """The cover; bold where it is too little."""
    text = f"{row['cover']:.3f}"
    return f"**{text}**" if row["cover"] < PLAUSIBLE[0] else text


def _bca(rows: Sequence[Row], size: int) -> str:
    lines = [
        [
            f"`{row['quantity']}`",
            f"{_cover(row)} ± {row['error']:.3f}",
            _cover(find(rows, quantity=row["quantity"], interval=PRINTED, n=size)),
        ]
        for row in rows
        if row["interval"] == BCA
    ]
    return markdown(["", f"BCa, n = {size}", "t, as printed"], lines)


def _rivals(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    heads = ["", *(f"{name}, n = {size}" for size in sizes for name in INTERVALS)]
    lines = []
    for name in dict.fromkeys(row["quantity"] for row in rows):
        if name.startswith(HULL):
            continue
        cells = [f"`{name}`"]
        for size in sizes:
            usual = find(rows, quantity=name, interval=PRINTED, n=size)
            for interval in INTERVALS:
                row = find(rows, quantity=name, interval=interval, n=size)
                cells.append(f"{_cover(row)} {_wider(row, usual)}")
        lines.append(cells)
    return markdown(heads, lines)


def _rivals_verdict(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """How many cases each interval loses: covers below the plausible range."""
    parts = []
    for name in INTERVALS:
        mine = _sized(rows, name, sizes)
        short = sum(row["cover"] < PLAUSIBLE[0] for row in mine)
        worst = min(row["cover"] for row in mine)
        parts.append(f"*{name}* {short} of {len(mine)} cases (worst {worst:.3f})")
    return f"Covers below {100 * PLAUSIBLE[0]:.0f} %: {', '.join(parts)}."


def _differences(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """Covers of paired differences: printed, and without credit for pairing."""
    heads = ["difference of", *(f"n = {size}: as printed | unpaired too" for size in sizes)]
    lines = []
    for name in (*NUMBERS, HULL):
        cells = [f"`{name}`"]
        for size in sizes:
            usual, wider = (
                find(rows, quantity=f"{name}, difference", interval=interval, n=size)
                for interval in (PRINTED, UNPAIRED)
            )
            cells += [_cover(usual), f"{_cover(wider)} {_wider(wider, usual)}"]
        lines.append(cells)
    return markdown(" | ".join(heads).split(" | "), lines)


def _wider(row: Row, usual: Row) -> str:
    """By how much an interval is wider than the printed one."""
    return f"(× {row['width'] / usual['width']:.2f})" if usual["width"] > 0 else "(× –)"


def better_difference(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """Which reading of the same height compares robots better: `worst_at` or the hull.

    Args:
        rows: Of the searches.
        sizes: The numbers of seeds that count; widths are those at the last one.
    """
    worst, hull = (
        [find(rows, quantity=f"{name}, difference", interval=PRINTED, n=size) for size in sizes]
        for name in ("worst_at", HULL)
    )
    covers = [min(row["cover"] for row in mine) for mine in (worst, hull)]
    widths = [mine[-1]["width"] for mine in (worst, hull)]
    text = (
        f"Worst cover as printed: {covers[0]:.3f} for `worst_at`, {covers[1]:.3f} for `{HULL}`; "
        f"mean width at n = {sizes[-1]}: {widths[0]:.3f} and {widths[1]:.3f}."
    )
    if covers[1] > covers[0] and widths[1] < widths[0]:
        return f"{text} So the hull is the better number to compare robots by."
    return text


def _largest_check(rows: Sequence[Row]) -> float:
    """By how much covers of both ways of drawing differ at most."""
    pairs = [(row, find(rows, quantity=row["quantity"], interval=PRINTED, n=row["n"]))
             for row in rows if row["interval"] == CHECK]  # fmt: skip
    return float(max(abs(mine["cover"] - other["cover"]) for mine, other in pairs))


def _shares(plan: Plan, share: Callable[[int], float]) -> str:
    return listed([f"{share(size):.2f} at n = {size}" for size in plan.sizes])
