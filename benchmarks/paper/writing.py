"""Everything that is written from what stands: tables, figures, account."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.kept import has_policy
from benchmarks.paper.account import account
from benchmarks.paper.crossplay import Player, play_all
from benchmarks.paper.drawing import draw_frontiers, draw_pairs
from benchmarks.paper.failing import failure_rows, keep_failures
from benchmarks.paper.measuring import Measuring
from benchmarks.paper.motions import motion_of
from benchmarks.paper.pages import write_pages
from benchmarks.paper.places import Places
from benchmarks.paper.plan import RECIPES, Plan
from benchmarks.paper.tables import (
    TITLES,
    body_rows,
    difference_rows,
    floor_rows,
    level_rows,
    measured_bodies,
    measured_recipes,
    measured_thoroughly,
    method_rows,
    natural_failure_rows,
    unseen_rows,
)
from benchmarks.study import once, write_table
from rigid.files import write_atomically
from rigid.policies.native import load_card
from rigid.report.tables import Row, latex
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task


def write_all(plan: Plan, places: Places, measuring: Measuring) -> None:
    """Writes what can be written of what is kept; what is missing is said to be missing."""
    task, results = make_task("itch-scratching"), places.results
    results.mkdir(parents=True, exist_ok=True)
    crossplay = _crossplay(plan, places, task)
    recipes = measured_recipes(plan, measuring)
    keep_failures(places, recipes, plan.robot_seeds)
    tables: dict[str, Sequence[Row]] = {
        "table": method_rows(recipes, crossplay),
        "differences": difference_rows(recipes),
        "unseen": unseen_rows(recipes, crossplay),
        "thorough": method_rows(measured_thoroughly(plan, measuring), crossplay),
        "bodies": body_rows(measured_bodies(plan, measuring)),
        "crossplay": crossplay,
        "levels": level_rows(recipes),
        "floors": floor_rows(recipes),
        "natural": natural_failure_rows(recipes),
        "failures": failure_rows(places, recipes, plan.robot_seeds),
    }
    for name, rows in tables.items():
        if rows:
            write_table(results / f"{name}.csv", rows)
    if tables["table"]:
        write_atomically(results / "table.tex", latex(tables["table"], TITLES).encode())
        draw_frontiers(results / "frontiers", recipes)
    if isinstance(task, ItchScratching):
        _draw_pairs(plan, places, task)
    if recipes:
        write_pages(places, recipes)
    text = account(plan, places, tables)
    write_atomically(results / "README.md", text.encode())


def _crossplay(plan: Plan, places: Places, task: Task) -> list[dict[str, Any]]:
    """Of all robots and humans that are kept; played again only when there are others."""
    robots = [
        Player(name, seed, places.kept_policy(name, seed))
        for name in _names(places, plan, "robot") for seed in plan.robot_seeds
        if has_policy(places.kept_policy(name, seed))
    ]  # fmt: skip
    humans = [
        Player(name, seed, places.kept_policy(name, seed))
        for name in _names(places, plan, "human") for seed in plan.robot_seeds
        if has_policy(places.kept_policy(name, seed))
    ]  # fmt: skip
    hashes = [load_card(player.policy).sha256 for player in (*robots, *humans)]
    path = places.kept_part("crossplay")
    asked = {"episodes": plan.evaluation_episodes, "policies": hashes}
    if path.exists() and json.loads(path.read_text())["of"] != asked:
        path.unlink()
    found: Mapping[str, Any] = once(
        path,
        lambda: {"of": asked, "rows": play_all(task, robots, humans, plan.evaluation_episodes)},
    )
    return list(found["rows"])


def _names(places: Places, plan: Plan, agent: str) -> list[str]:
    """Names under which policies of an agent are kept: recipes in their order, then others."""
    folders = [places.kept_policy("", seed) for seed in plan.robot_seeds]
    kept = {path.name for folder in folders if folder.is_dir() for path in folder.iterdir()}
    mine = {
        name for name in kept
        for seed in plan.robot_seeds
        if has_policy(places.kept_policy(name, seed))
        and load_card(places.kept_policy(name, seed)).agent == agent
    }  # fmt: skip
    first = RECIPES if agent == "robot" else ("human",)
    return [*(name for name in first if name in mine), *sorted(mine - {*first, "expert"})]


def _draw_pairs(plan: Plan, places: Places, task: ItchScratching) -> None:
    motions = [
        motion_of(task, seed, _kept(places, "expert", seed), _kept(places, "human", seed))
        for seed in plan.robot_seeds
        if has_policy(_kept(places, "human", seed))
    ]
    if motions:
        draw_pairs(places.results / "pairs", motions)


def _kept(places: Places, name: str, seed: int) -> Path:
    return places.kept_policy(name, seed)
