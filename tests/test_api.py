"""Measuring from Python: names or objects go in, an object with every number comes out."""

from __future__ import annotations

import json

import pytest

import rigid
from rigid import UserError
from rigid.presets import PRESETS
from tests.compute.tiny import TINY, FilmedReach, install_toy, measured_once, store_pair


@pytest.fixture(scope="module")
def base(tmp_path_factory):
    base = tmp_path_factory.getbasetemp()
    store_pair(base / "pair")
    return base


@pytest.fixture(scope="module")
def small_run(base):
    return measured_once(base, "small")


def test_a_task_may_be_named(base, small_run, monkeypatch):
    monkeypatch.syspath_prepend(install_toy(base))
    robot, human = str(base / "pair" / "robot"), str(base / "pair" / "human")
    again = rigid.measure(
        "toy-reach", robot, out=str(small_run.directory), preset=TINY, seeds=range(2), human=human
    )
    assert again.data == small_run.data


def test_a_terminal_sees_a_bar_and_a_log_nothing(base, capsys, monkeypatch):
    monkeypatch.syspath_prepend(install_toy(base))
    pair = base / "pair"

    def measured(place):
        rigid.measure(
            "toy-reach", str(pair / "robot"), out=place, preset=TINY, seeds=[0], lambdas=[1.0],
            human=str(pair / "human"),
        )  # fmt: skip
        return capsys.readouterr()

    assert measured(base / "silent") == ("", "")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    out, err = measured(base / "seen")
    assert out == ""
    assert "training steps; about" in err


def test_a_result_offers_its_headline_as_attributes(small_run):
    data = json.loads((small_run.directory / "frontier.json").read_text())
    assert small_run.points == data["points"]
    assert small_run.worst_at == data["worst_at"]
    assert small_run.auc == data["auc"]
    assert small_run.auc_natural == data["auc_natural"]
    assert small_run.auc_interval == tuple(data["auc_interval"])


def test_a_result_can_be_loaded_again(small_run):
    assert rigid.load_frontier(str(small_run.directory)).data == small_run.data


def test_a_result_draws_its_report_where_it_is_told(small_run, tmp_path):
    assert small_run.report(str(tmp_path / "r.html")) == tmp_path / "r.html"
    assert (tmp_path / "r.html").stat().st_size > 10_000


def test_the_area_of_the_points_is_the_pooled_one(small_run):
    points = [(p["naturalness"], p["adversarialness"]) for p in small_run.points]
    anchor = small_run.data["canonical"]["adversarialness"]
    pooled = rigid.area_under_frontier(points, anchor=anchor)
    assert pooled == pytest.approx(small_run.data["auc_pooled"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"preset": "papper"}, "preset 'papper' is unknown, did you mean 'paper'"),
        ({"task": "itch-scraching"}, "unknown task 'itch-scraching', did you mean"),
        ({"robot": "builtin:none"}, "robot 'builtin:none' is unknown"),
        ({"seeds": [1, 1]}, r"seeds must be distinct and not negative, got \[1, 1\]"),
        ({"lambdas": [-1]}, r"lambdas must be distinct, each 0 or more or inf, got \[-1\.0\]"),
    ],
)
def test_bad_input_is_a_users_error_and_writes_nothing(tmp_path, options, message):
    given = {"task": FilmedReach(), "robot": "builtin:none", "preset": TINY, **options}
    with pytest.raises(UserError, match=message):
        rigid.measure(given.pop("task"), given.pop("robot"), out=tmp_path / "run", **given)
    assert not (tmp_path / "run").exists()


def test_presets_train_for_as_many_steps_as_the_documents_say():
    documented = {"demo": 576_000, "standard": 4_608_000, "paper": 31_104_000}
    assert {name: PRESETS[name].env_steps(100) for name in documented} == documented


def test_presets_describe_themselves_as_json():
    for name, preset in PRESETS.items():
        described = json.loads(json.dumps(preset.describe()))
        assert described["name"] == name
