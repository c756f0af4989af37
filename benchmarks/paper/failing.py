"""How each robot fails, by kind and as a figure of keypoints; kept while raw runs are there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.paper.places import Places
from benchmarks.study import once
from rigid.files import write_atomically
from rigid.frontier.result import FILE
from rigid.report import sources
from rigid.report.failures import failure_modes
from rigid.report.keypoints import keypoint_figure, save_figure

Row = dict[str, Any]


def keep_failures(places: Places, names: Iterable[str], seeds: Sequence[int]) -> None:
    """Keeps kinds and figure of every raw run that is here.

    Args:
        places: Where things lie.
        names: Of frontiers.
        seeds: Of robots.
    """
    for name in names:
        for seed in seeds:
            run, drawn = places.run(name, seed), figure_of(places, name, seed)
            if not (run / FILE).exists():
                continue
            once(_part(places, name, seed), partial(failure_modes, run))
            if not drawn.exists():
                drawn.parent.mkdir(parents=True, exist_ok=True)
                write_atomically(drawn, _keypoints(run))


def failure_rows(places: Places, names: Iterable[str], seeds: Sequence[int]) -> list[Row]:
    """`failures.csv`: a row for each kind of failure of each robot that is kept."""
    rows: list[Row] = []
    for name in names:
        for seed in seeds:
            path = _part(places, name, seed)
            known = (once(path, dict) if path.exists() else None) or {"modes": ()}
            for mode in known["modes"]:
                low, high = mode["naturalness"]
                rows.append({
                    "method": name, "robot_seed": seed, "failure": mode["title"],
                    "humans": len(mode["points"]), "of": known["humans"],
                    "naturalness_low": low, "naturalness_high": high, "share": mode["share"],
                })  # fmt: skip
    return rows


def figure_of(places: Places, name: str, seed: int) -> Path:
    """The figure of a robot's failures."""
    return places.results / "failures" / f"{name}-{seed}.svg"


def _part(places: Places, name: str, seed: int) -> Path:
    return places.kept_part(f"failures-{name}-{seed}")


def _keypoints(directory: Path) -> bytes:
    """The most harmful human of each band of naturalness, and what it did at its worst."""
    run = sources.open_run(directory)
    points = sources.worst_by_band(run.frontier.points)
    shown = [sources.stored(run, point, "worst") for point in points]
    return save_figure(keypoint_figure(run.scene, shown), ".svg")
