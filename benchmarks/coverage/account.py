"""The account: a text filled from the table, so that the two cannot disagree."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.coverage.account_tables import (
    bca_table,
    covers_table,
    differences_table,
    gate_table,
    gated,
    rivals_table,
    sized,
)
from benchmarks.coverage.ends import INTERVALS
from benchmarks.coverage.plan import MOST_ABOVE, PLAUSIBLE, QUICK, Plan
from benchmarks.coverage.searching import HULL
from benchmarks.coverage.tables import BCA, CHECK, GATE, PRINTED, Row
from benchmarks.paired import find
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
        searches_verdict=verdict(sized(headline, PRINTED, plan.sizes)),
        searches=covers_table(headline, PRINTED, plan.sizes),
        laws_verdict=verdict(sized(laws, PRINTED, plan.sizes)),
        laws=covers_table(laws, PRINTED, plan.sizes),
        why=why(sized(rows, PRINTED, plan.sizes)),
        bca_size=plan.bca_size,
        bca_verdict=verdict([row for row in rows if row["interval"] == BCA]),
        bca=bca_table(rows, plan.bca_size),
        jumps=jumps(population, plan.tolerances),
        differences=differences_table(searches, plan.sizes),
        better=better_difference(searches, plan.sizes),
        rivals=rivals_table(rows, plan.shown),
        rivals_verdict=_rivals_verdict(rows, plan.sizes),
        gate=gate_table(rows, plan.sizes), gate_verdict=gate_verdict(rows, plan.sizes),
        most_above=100 * MOST_ABOVE,
        absent=_shares(plan, lambda n: 0.9**n),
        excluded=_shares(plan, lambda n: 1 - 0.025 ** (1 / n)),
        tolerances=listed([f"{one:g}" for one in plan.tolerances]),
        lambdas=sum(preset.per_round), lambda_min=preset.lambda_min, lambda_max=preset.lambda_max,
        iterations=preset.iterations, episodes=preset.episodes, referee=preset.referee_episodes,
        validation=preset.validation_episodes, scoring=preset.scoring_episodes,
        draws=plan.draws, redraws=plan.redraws, bca_draws=plan.bca_draws,
        check=_largest_check(searches),
        error_low=min(row["error_results"] for row in sized(searches, PRINTED, plan.sizes)),
        error_high=max(row["error_results"] for row in sized(searches, PRINTED, plan.sizes)),
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
            "interval is too low and too narrow together. So it is the *upper* end that promises "
            "too much, and `rigid gate` holds another one against a limit (below)."
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


def _rivals_verdict(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """How many cases each interval loses: covers below the plausible range."""
    parts = []
    for name in INTERVALS:
        mine = sized(rows, name, sizes)
        short = sum(row["cover"] < PLAUSIBLE[0] for row in mine)
        worst = min(row["cover"] for row in mine)
        parts.append(f"*{name}* {short} of {len(mine)} cases (worst {worst:.3f})")
    return f"Covers below {100 * PLAUSIBLE[0]:.0f} %: {', '.join(parts)}."


def gate_verdict(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """How many cases each upper bound loses: truths above it too often.

    Args:
        rows: Of the table.
        sizes: The numbers of seeds that count.
    """
    parts = []
    for label, interval in (("t", PRINTED), ("gate", GATE)):
        above = [row["truth_above"] for row in gated(rows, interval, sizes)]
        often = sum(share > MOST_ABOVE for share in above)
        parts.append(f"*{label}* {often} of {len(above)} cases (worst {max(above):.3f})")
    return f"Truth above the bound in more than {100 * MOST_ABOVE:g} %: {', '.join(parts)}."


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
