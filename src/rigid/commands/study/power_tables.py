"""What `rigid study power` prints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rigid.study.bounds import Chance, players_needed
from rigid.study.power import ChoiceDesign, Design, Power

_COUNTS = (0, 1, 2, 3)
_SHARES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3)
"""Columns and rows of the table of bounds."""


def power_json(power: Power) -> dict[str, Any]:
    """A power with its size."""
    return {**power.size._asdict(), "power": power.share, "error": power.error}


def design_lines(kind: str, design: Design, simulations: int) -> list[str]:
    """What is asked, and what is taken for true."""
    if isinstance(design, ChoiceDesign):
        what = (
            f"is the preference within {design.margin:g} of one half? true: {design.preference:g}"
        )
        unit = "log odds"
    else:
        what = f"does the second of a pair score higher? true: by {design.difference:g} points"
        unit = "points"
    spread = f"raters differ by {design.sd_raters:g} {unit}, pairs by {design.sd_pairs:g}"
    return [f"{kind}: {what}", f"{spread}; {simulations} simulated studies of each size"]


def grid(powers: Sequence[Power]) -> list[str]:
    """Raters by pairs, each power with its error."""
    raters = sorted({power.size.raters for power in powers})
    pairs = sorted({power.size.pairs for power in powers})
    found = {(power.size.raters, power.size.pairs): power for power in powers}
    head = f"{'power':>8}  " + "  ".join(f"{f'{p} pairs':>11}" for p in pairs)
    rows = [
        f"{f'{r} raters':>9} " + "  ".join(f"{_share(found[r, p]):>11}" for p in pairs)
        for r in raters
    ]
    return [head, *rows]


def _share(power: Power) -> str:
    return f"{power.share:.2f} ± {power.error:.2f}"


def smallest_lines(least: Mapping[float, Sequence[Power]]) -> list[str]:
    """The smallest sizes of each power."""
    lines = []
    for wanted, powers in least.items():
        sizes = [f"{p.size.raters} raters × {p.size.pairs} pairs ({_share(p)})" for p in powers]
        named = " or ".join(sizes) or "none of these sizes: try more raters and more pairs"
        lines.append(f"for {wanted:g}: {named}")
    return lines


def players_table(
    chances: Iterable[Chance],
    *,
    at_most: float,
    above: float,
    needed: Mapping[float, Chance | None],
) -> list[str]:
    """What numbers of players can show of exhaustiveness."""
    asks = f"exhaustiveness: do at most {at_most:.0%} of people lie above the frontier?"
    lines = [
        f"{asks} true: {above:.2%}",
        "",
        f"players  if none is above  for at most {at_most:.0%}  power",
    ]
    for c in chances:
        may = "too few" if c.allowed is None else f"{c.allowed} may be"
        lines.append(
            f"{c.players:7}  {f'at most {c.at_most_if_none:.1%}':>16}  {may:>15}  {c.chance:.2f}"
        )
    lines.append("")
    for wanted, found in needed.items():
        named = "no number: the true share is too near" if found is None else (
            f"{found.players} players, of whom {found.allowed} may be above"
        )  # fmt: skip
        lines.append(f"for {wanted:g}: {named}")
    return lines


def needed_table() -> list[str]:
    """How many players each bound takes."""
    head = "at most  " + "  ".join(f"{f'{count} above':>8}" for count in _COUNTS)
    rows = [
        f"{share:7.0%}  " + "  ".join(f"{players_needed(count, share):>8}" for count in _COUNTS)
        for share in _SHARES
    ]
    return ["players that the bound of 95 % takes (Clopper and Pearson):", head, *rows]


def study_table(
    players: Sequence[tuple[str, Chance]],
    raters: Sequence[tuple[str, str, Power]],
    *,
    at_most: float,
) -> list[str]:
    """What each role of a study can show."""
    lines = []
    for role, found in players:
        may = (
            f"too few for at most {at_most:.0%}"
            if found.allowed is None
            else f"for at most {at_most:.0%}, {found.allowed} may be (power {found.chance:.2f})"
        )
        lines.append(
            f"{role}: {found.players} players; if none is above the frontier, at most "
            f"{found.at_most_if_none:.0%} of people are; {may}"
        )
    for role, kind, power in raters:
        lines.append(
            f"{role}: {kind}, {power.size.raters} raters × {power.size.pairs} pairs: "
            f"power {_share(power)}"
        )
    return lines or ["nobody plays or judges in this study"]
