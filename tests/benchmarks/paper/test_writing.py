"""What is written of a study that has only begun."""

from __future__ import annotations

import json

from benchmarks.paper.account import teachers
from benchmarks.paper.making import SCRATCH
from benchmarks.paper.measuring import Measuring
from benchmarks.paper.places import Places
from benchmarks.paper.writing import write_all
from rigid.tasks.registry import make_task
from tests.benchmarks.paper.samples import PLAN, keep


def test_tables_figures_and_account_are_written_from_what_stands_and_again_alike(tmp_path):
    places = Places(tmp_path / "raw", tmp_path / "results")
    for name in ("vanilla", "palm"):
        keep(places, name, 0, {0: 0.5, 1: 0.6})
    measuring = Measuring(PLAN, places, make_task("itch-scratching"))
    write_all(PLAN, places, measuring)
    tables = ("table", "differences", "levels", "floors", "natural", "unseen")
    names = {*(f"{name}.csv" for name in tables), "table.tex", "README.md"}
    names |= {"frontiers.svg", "frontiers.pdf", "comparison.html", "figures.html"}
    assert names <= {path.name for path in places.results.iterdir()}
    before = {name: (places.results / name).read_bytes() for name in names}
    write_all(PLAN, places, measuring)
    assert {name: (places.results / name).read_bytes() for name in names} == before


def test_a_variant_of_one_robot_takes_none_from_the_page_of_the_others(tmp_path):
    places = Places(tmp_path / "raw", tmp_path / "results")
    for name, seed in (("vanilla", 0), ("vanilla", 1), (SCRATCH, 0)):
        keep(places, name, seed, {0: 0.5, 1: 0.6})
    write_all(PLAN, places, Measuring(PLAN, places, make_task("itch-scratching")))
    assert "3 robots, preset" in (places.results / "comparison.html").read_text()


def test_the_account_names_the_seeds_that_robust_gt_learned_from_by_its_card(tmp_path):
    places = Places(tmp_path / "raw", tmp_path / "results")
    assert teachers(PLAN, places) == "No robot of Robust GT stands yet."
    card = places.kept_policy("robust-gt", 1) / "policy.json"
    card.parent.mkdir(parents=True)
    found = [{"id": name} for name in ("s101-r3-l3", "s100-r1-l2", "s101-r1-l1")]
    card.write_text(json.dumps({"provenance": {"adversaries": found}}))
    assert "robot 1 from 3 of 100, 101. It is judged" in teachers(PLAN, places)
