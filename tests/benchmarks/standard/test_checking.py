"""Parts that were measured elsewhere have to be of the same study."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace

import pytest

from benchmarks.standard.checking import check_parts, makers
from benchmarks.standard.making import Workplace
from benchmarks.standard.plan import Part
from rigid.compute.listening import Silence
from rigid.errors import UserError
from tests.benchmarks.standard.planting import SMALL, VANILLA, plant

ALONE = replace(SMALL, robots=(VANILLA,))
PARTS = [Part(VANILLA, preset, seed) for preset in ("standard", "paper") for seed in (0, 1)]


@pytest.fixture
def place(tmp_path):
    """All parts of one robot, kept."""
    place = Workplace(ALONE, tmp_path / "runs", tmp_path / "results")
    for part in PARTS:
        plant(place.order(part, Silence()))
        place.keep(part)
    return place


def change(directory, **entries):
    """Changes entries of a part's identity."""
    path = directory / "settings.json"
    settings = json.loads(path.read_text(encoding="utf-8"))
    settings["identity"] |= entries
    path.write_text(json.dumps(settings), encoding="utf-8")


def refusal(place):
    with pytest.raises(UserError) as caught:
        check_parts(place)
    return str(caught.value)


def test_parts_of_one_study_pass(place):
    check_parts(place)


def test_a_part_of_another_budget_is_refused_with_the_cure(place):
    place.plan = replace(ALONE, standard=replace(ALONE.standard, iterations=7))
    assert refusal(place) == (
        f"{place.kept(PARTS[0])} was made with preset.iterations 80, but the study asks for 7: "
        "delete it, or choose other places with --out and --results"
    )


@pytest.mark.parametrize("entry", ["robot", "human", "task"])
def test_a_part_of_another_robot_human_or_task_is_refused(place, entry):
    change(place.kept(PARTS[1]), **{entry: "another"})
    assert f"{place.kept(PARTS[1])} was made with {entry} another, but the study" in refusal(place)


def test_a_part_with_more_seeds_than_its_own_is_refused(place):
    path = place.kept(PARTS[3]) / "settings.json"
    settings = json.loads(path.read_text(encoding="utf-8")) | {"seeds": [1, 2]}
    path.write_text(json.dumps(settings), encoding="utf-8")
    assert "paper/seed-1 was made with seeds [1, 2], but the study asks for [1]" in refusal(place)


def test_a_pair_that_differs_in_more_than_its_preset_is_refused(place):
    for part in PARTS[2:]:
        change(place.kept(part), measure="mmd")
    assert "paper/seed-0 was made with measure mmd, but other parts of the robot with lsgan" in (
        refusal(place)
    )


def test_seeds_whose_adversaries_were_trained_otherwise_are_refused(place):
    change(place.kept(PARTS[3]), adversary={"rate": "another"})
    assert "paper/seed-1 was made with adversary.rate another, but other parts" in refusal(place)


def test_a_part_under_way_is_looked_at_as_well(place):
    (place.kept(PARTS[3]) / "frontier.json").unlink()
    change(place.raw(PARTS[3]), measure="mmd")
    assert f"{place.raw(PARTS[3])} was made with measure mmd" in refusal(place)


def test_a_kept_seed_outside_the_plan_is_looked_at_as_well(place):
    place.plan = ALONE.with_seeds([0])
    change(place.kept(PARTS[1]), human="another")
    assert "seed-1 was made with human another" in refusal(place)


def test_what_parts_were_made_with_is_counted(place):
    path = place.kept(PARTS[0]) / "settings.json"
    settings = json.loads(path.read_text(encoding="utf-8"))
    made = {"rigid": "9.9", "git_commit": "0123456789abcdef", "machine": "Other m"}
    settings["provenance"] = made | {"versions": {"mujoco": "1.0", "jax": "2.0"}}
    path.write_text(json.dumps(settings), encoding="utf-8")
    found = makers(place)
    assert found["RIGID 9.9 (012345678), jax 2.0, mujoco 1.0, Other m"] == 1
    assert sorted(Counter(found).values()) == [1, 3]
