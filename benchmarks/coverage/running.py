"""The study from its searches to its account."""

from __future__ import annotations

from pathlib import Path

from benchmarks.coverage.account import write_account
from benchmarks.coverage.drawing import draw
from benchmarks.coverage.plan import Plan
from benchmarks.coverage.searching import population
from benchmarks.coverage.tables import law_rows, search_rows, series_of
from benchmarks.study import say, write_table


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Makes what is missing in `out`, then writes everything into `results`.

    Raises:
        UserError: `out` holds searches of other settings, or cannot be written.
    """
    found = population(plan, out)
    write_table(results / "seeds.csv", found)
    series = series_of(found, plan.tolerances)
    say("drawing from the searches, then from the laws: some minutes")
    rows = [*search_rows(series, plan), *law_rows(plan)]
    write_table(results / "table.csv", rows)
    draw(results / "figure.svg", rows, plan)
    write_account(results / "README.md", plan, found, rows)
    say(f"written: {results / 'README.md'}")
