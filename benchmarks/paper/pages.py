"""The comparison and all figures as pages that open in a browser."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import replace
from itertools import takewhile
from pathlib import Path

from benchmarks.paper.failing import figure_of
from benchmarks.paper.places import Places
from benchmarks.paper.plan import RECIPES
from benchmarks.paper.tables import TITLES, Measured
from rigid.commands.measured import load_measured
from rigid.files import write_atomically
from rigid.frontier.standings import notes_of, standings_of
from rigid.report.comparison import comparison_page

Figure = tuple[str, Path]
"""What it shows, and its SVG."""

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src 'self' file:; \
style-src 'unsafe-inline'">
<title>Figures · the paper's experiments · RIGID</title>
<style>
body {{ max-width: 1100px; margin: 0 auto; padding: 28px; background: #fdfcfa; color: #1c1d21; \
font: 15px/1.5 system-ui, sans-serif; }}
figure {{ margin: 36px 0; }}
img {{ width: 100%; height: auto; }}
figcaption {{ color: #5e6068; }}
</style>
</head>
<body>
<h1>Figures of the paper's experiments</h1>
<p><a href="comparison.html">The comparison</a> · <a href="README.md">the account</a></p>
{figures}
</body>
</html>
"""


def write_pages(places: Places, measured: Measured) -> None:
    """Writes `comparison.html` and `figures.html`.

    Args:
        places: Where things lie; reports of the raw runs that are there are linked.
        measured: Frontiers by method and robot seed.
    """
    _write_comparison(places, measured)
    figures: list[Figure] = [
        ("Frontiers of all methods", places.results / "frontiers.svg"),
        ("How the pairs of different seeds move", places.results / "pairs.svg"),
        *(
            (f"Failures of {TITLES.get(name, name)}, robot {seed}", figure_of(places, name, seed))
            for name, robots in measured.items() for seed in robots
        ),
    ]  # fmt: skip
    drawn = [(caption, path) for caption, path in figures if path.exists()]
    write_atomically(places.results / "figures.html", _figures(drawn, places.results).encode())


def _write_comparison(places: Places, measured: Measured) -> None:
    """Of the robot seeds that every recipe has, since robots are compared in pairs.

    Variants, which have the first robot alone, stand beside them with what they have.
    """
    recipes = [set(robots) for name, robots in measured.items() if name in RECIPES]
    seeds = sorted(set.intersection(*recipes)) if recipes else []
    methods = {}
    for name, robots in measured.items():
        shared = list(takewhile(robots.__contains__, seeds))  # Robots pair by their place.
        kept = [(load_measured(places.kept_run(name, seed)), seed) for seed in shared]
        methods[TITLES.get(name, name)] = [
            (replace(frontier, directory=places.run(name, seed)), identity)
            for (frontier, identity), seed in kept
        ]
    methods = {title: robots for title, robots in methods.items() if robots}
    if not methods:
        return
    standings = standings_of(methods)
    path = places.results / "comparison.html"
    write_atomically(path, comparison_page(standings, notes_of(standings), at=path).encode())


def _figures(figures: Sequence[Figure], at: Path) -> str:
    shown = (
        f'<figure>\n<img src="{html.escape(path.relative_to(at).as_posix())}" alt="">\n'
        f"<figcaption>{html.escape(caption)}</figcaption>\n</figure>"
        for caption, path in figures
    )
    return _PAGE.format(figures="\n".join(shown))
