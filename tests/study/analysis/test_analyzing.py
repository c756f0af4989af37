"""`rigid study analyze` on studies of toys: what it reads, refuses, writes and says."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from rigid.commands.study.analyzing import AnalyzeCommand
from rigid.data.pair_file import save_pairs
from rigid.errors import UserError
from rigid.study.plan import JudgeStage, Role
from rigid.study.registration import register_study
from rigid.study.store import Store
from tests.compute.shown_reach import ShownReach, count_as_rigids_own
from tests.study.analysis.scripted_answers import check, halves, made_pairs, pair_file
from tests.study.toys import consented, played_study, toy_plan, toy_record


def analyzed(data, out, **options):
    assert AnalyzeCommand(data=data, out=out, **options).run() == 0
    return json.loads((out / "analysis.json").read_text(encoding="utf-8"))


def raters(data, folder, answers, *, kind="person"):
    """A study of one questionnaire, answered."""
    path = folder / "pairs.json"
    save_pairs(path, pair_file(made_pairs(30), "faithfulness"))
    stage = JudgeStage(question="correspondence", pairs=path, count=30)
    plan = toy_plan(roles={"rater": Role(participants=16, stages=(stage,))})
    with Store.open(data, plan) as store:
        register_study(store, plan)
        codes: dict[str, str] = {}
        for one in answers:
            if one.participant not in codes:
                codes[one.participant] = consented(store, "rater", kind=kind)
            store.add_answer(replace(one, participant=codes[one.participant]))
    return data


@pytest.fixture
def own(monkeypatch):
    """Counts the toy task among RIGID's own."""
    count_as_rigids_own(monkeypatch)


@pytest.fixture
def players(base, tmp_path, monkeypatch):
    """Two people and a script who played with the robot of the toy run."""
    count_as_rigids_own(monkeypatch)
    plan = toy_plan({"a": str(base / "pair" / "robot")})
    task = ShownReach()
    with played_study(tmp_path / "data", task, plan) as store:
        code = consented(store, kind="scripted")
        for number in range(3):
            record = toy_record(
                task, code, number, device="scripted", about_device={"script": "tremble"}
            )
            store.add_episode(record, 2)
    return tmp_path / "data"


def test_everybody_is_placed_and_scripts_are_counted_nowhere(players, single_run, tmp_path):
    out = tmp_path / "out"
    found = analyzed(players, out, runs=(str(single_run.directory),))
    kinds = {row["name"]: row["kind"] for row in found["placed"]}
    assert kinds == {"P01": "person", "P02": "person", "tremble": "scripted"}
    (count,) = found["counts"]
    assert count["people"]["of"] == 2
    assert found["robots"]["a"]["referees"] == len(single_run.points)
    assert found["people"] == {"novice": 2}
    assert {path.name for path in out.iterdir()} == {
        "analysis.json", "placed.csv", "study.html", "people-a.svg", "people-a.pdf",
    }  # fmt: skip
    with (out / "placed.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["kind"] for row in rows] == ["person", "person", "scripted"]
    assert "of 2, at most" in "".join(found["findings"]) or "no claim" in found["findings"][0]


def test_equal_studies_give_equal_files(players, single_run, tmp_path):
    both = [tmp_path / name for name in ("one", "two")]
    for out in both:
        analyzed(players, out, runs=(f"a={single_run.directory}",))
    for path in both[0].glob("*"):
        assert path.read_bytes() == (both[1] / path.name).read_bytes()


def test_a_robot_without_a_run_is_named_and_its_people_are_not_placed(players, tmp_path):
    found = analyzed(players, tmp_path / "out")
    assert found["unmeasured"] == ["a"]
    assert not found["placed"]
    assert any("no run was named for robot a" in note for note in found["notes"])


@pytest.mark.usefixtures("own")
def test_a_run_of_another_robot_is_refused(single_run, tmp_path):
    with played_study(tmp_path / "data", ShownReach(), toy_plan()):
        pass
    with pytest.raises(UserError, match=r"which is no robot of this study \(a \(builtin:vanilla"):
        analyzed(tmp_path / "data", tmp_path / "out", runs=(str(single_run.directory),))


@pytest.mark.usefixtures("own")
def test_a_run_under_the_key_of_a_robot_with_another_hash_is_refused(
    single_run, tmp_path, monkeypatch
):
    plan = toy_plan()
    with played_study(tmp_path / "data", ShownReach(), plan):
        pass
    monkeypatch.setattr(Store, "registered", lambda _: {"robots/a": "0" * 64})
    with pytest.raises(UserError, match="measured another robot than 'a' of the study was"):
        analyzed(tmp_path / "data", tmp_path / "out", runs=(f"a={single_run.directory}",))


def test_raters_of_known_law_are_recovered(tmp_path):
    found = analyzed(raters(tmp_path / "data", tmp_path, halves()), tmp_path / "out")
    (judged,) = found["judged"]
    low, high = judged["everybody"]["preference"]["interval"]
    assert low <= 0.65 <= high
    assert judged["of"] == "person"
    assert judged["attentive"] is None
    assert found["registered"] is True
    assert (tmp_path / "out" / "correspondence-pairs.pdf").exists()


def test_who_fails_an_attention_check_is_named_and_left_out_beside_the_headline(tmp_path):
    answers = halves() + [check(rater, passed=rater != 3) for rater in range(16)]
    found = analyzed(raters(tmp_path / "data", tmp_path, answers), tmp_path / "out")
    (judged,) = found["judged"]
    assert judged["everybody"]["preference"]["share"]["raters"] == 16
    assert judged["attentive"]["preference"]["share"]["raters"] == 15
    assert any("P04 failed an attention check" in line for line in found["findings"])


def test_scripted_raters_are_a_pilot_and_no_finding(tmp_path):
    data = raters(tmp_path / "data", tmp_path, halves(4), kind="scripted")
    found = analyzed(data, tmp_path / "out")
    assert found["judged"][0]["of"] == "scripted"
    assert any("a pilot, no finding" in note for note in found["notes"])
    assert found["unmeasured"] == []  # Nobody met the robot.
    assert "nobody but scripts took part" in (tmp_path / "out" / "study.html").read_text()


def test_another_margin_than_the_registered_one_confirms_nothing(tmp_path):
    data = raters(tmp_path / "data", tmp_path, halves(4))
    found = analyzed(data, tmp_path / "out", margin=0.2)
    assert found["registered"] is False
    assert any("its tests confirm nothing" in note for note in found["notes"])
    assert "exploratory" in (tmp_path / "out" / "study.html").read_text()


@pytest.mark.parametrize("margin", [0.0, 0.5, -0.1])
def test_a_margin_that_is_none_is_refused(tmp_path, margin):
    with pytest.raises(UserError, match=f"--margin is {margin:g}, but a preference lies"):
        analyzed(tmp_path / "data", tmp_path / "out", margin=margin)


def test_pairs_that_changed_since_are_refused(tmp_path):
    data = raters(tmp_path / "data", tmp_path, halves(4))
    save_pairs(tmp_path / "pairs.json", pair_file(made_pairs(30, seed=5), "faithfulness"))
    with pytest.raises(UserError, match="is not the pair file that the study was registered with"):
        analyzed(data, tmp_path / "out")


def test_a_study_without_data_is_refused(tmp_path):
    with Store.open(tmp_path / "data", toy_plan()):
        pass
    with pytest.raises(UserError, match="nobody has played or answered yet"):
        analyzed(tmp_path / "data", tmp_path / "out")


def test_a_directory_without_a_study_is_refused(tmp_path):
    with pytest.raises(UserError):
        analyzed(tmp_path / "none", tmp_path / "out")


def test_json_goes_to_standard_output_whole(tmp_path, capsys):
    data = raters(tmp_path / "data", tmp_path, halves(4))
    found = analyzed(data, tmp_path / "out", json=True)
    assert json.loads(capsys.readouterr().out) == found


def test_no_page_ever_says_that_a_frontier_is_exhaustive(players, single_run, tmp_path):
    analyzed(players, tmp_path / "out", runs=(str(single_run.directory),))
    for path in (tmp_path / "out").glob("*.*"):
        assert "exhausti" not in path.read_bytes().decode("latin-1").lower()


def test_the_source_never_says_so_either():
    folder = Path(__file__).parents[3] / "src" / "rigid" / "study" / "analysis"
    for path in (*folder.glob("*.py"), *folder.glob("*.html")):
        assert not re.search("exhausti", path.read_text(encoding="utf-8"), re.IGNORECASE)
