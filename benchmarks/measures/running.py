"""The study from its plan to its account."""

from __future__ import annotations

from pathlib import Path

from benchmarks.measures.account import account
from benchmarks.measures.drawing import draw
from benchmarks.measures.plan import Plan
from benchmarks.measures.searching import run_searches
from benchmarks.measures.summary import (
    cost_rows,
    headline_rows,
    point_rows,
    share_rows,
    union_rows,
)
from benchmarks.study import say, write_table
from rigid.files import write_atomically


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Searches what is missing in `out`, then writes everything into `results`.

    Raises:
        UserError: `out` holds searches of another plan, or cannot be written.
    """
    searched = {one.search.name: one for one in run_searches(plan, out)}
    rows = [
        *headline_rows(searched),
        *union_rows(searched),
        *share_rows(searched, plan.measures),
        *cost_rows(searched),
    ]
    write_table(results / "table.csv", rows)
    write_table(results / "points.csv", point_rows(searched, plan.measures))
    draw(results / "figure.svg", searched, rows, plan.measures)
    text = account(plan, searched, rows)
    write_atomically(results / "README.md", text.encode())
    say(f"written: {results / 'README.md'}")
