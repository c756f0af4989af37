"""`--return-range` and `rigid calibrate` on the command line."""

from __future__ import annotations

import json

import pytest

from rigid.commands.calibrating import said, too_far
from rigid.compute import calibration


@pytest.mark.parametrize("option", [["--return-range", "-100,20"], ["--return-range=-100,20"]])
def test_a_range_may_begin_with_a_minus(rigid, toy_options, option):
    code, out, _ = rigid("evaluate", *toy_options, "--episodes", 5, "--json", *option)
    found = json.loads(out)
    assert code == 0
    assert (found["return_range"], found["range_source"]) == ([-100.0, 20.0], "option")
    assert found["adversarialness"] == pytest.approx((20 - found["return"]) / 120)


def test_evaluate_says_what_adversarialness_is(rigid, toy_options):
    _, out, _ = rigid("evaluate", *toy_options, "--episodes", 5)
    assert "adversarialness is 0 at a return of 0, 1 at -20 (the task's range)" in out


@pytest.mark.parametrize("command", ["frontier", "doctor"])
def test_a_bad_range_exits_with_2_and_writes_nothing(rigid, toy_options, command, tmp_path):
    given = ["--out", tmp_path / "run", "--return-range", "20,-100"]
    code, _, err = rigid(command, *toy_options, *given)
    assert code == 2
    assert "is 20,-100, but must be two returns LOW,HIGH" in err
    assert not list(tmp_path.glob("run/*"))


def test_compare_takes_a_range_for_robots_alone(rigid, two_runs):
    code, _, err = rigid("compare", *two_runs, "--return-range", "-1,0")
    assert code == 2
    assert "--return-range is for --robots: name the robots to be measured" in err


def test_compare_refuses_unequal_ranges_and_names_both(rigid, two_runs):
    path = two_runs[1] / "frontier.json"
    data = json.loads(path.read_text()) | {"return_range": [-30.0, 0.0]}
    path.write_text(json.dumps(data))
    code, _, err = rigid("compare", *two_runs)
    assert code == 2
    assert "their ranges of adversarialness are [-20.0, 0.0] and [-30.0, 0.0]" in err


FOUND = {
    "worst": -8.0, "best": 2.0,
    "returns": {
        "canonical": {"mean": 1.9, "episodes": 200, "quantiles": {"0.05": -1.0, "0.95": 4.0}},
        "sabotage": {"mean": -8.1, "episodes": 60, "quantiles": {"0.05": -9.0, "0.95": -7.0}},
    },
}  # fmt: skip


def test_calibrate_passes_on_budget_and_seeds(rigid, toy_options, tmp_path, monkeypatch):
    heard = {}

    def calibrate(subject, preset, **options):
        heard.update(options, iterations=preset.iterations, seeds=preset.seeds, robot=subject.robot)
        return FOUND

    monkeypatch.setattr(calibration, "calibrate", calibrate)
    given = ["--preset", "tiny", "--iterations", 5, "--seeds", "3,4", "--out", tmp_path / "r.json"]
    code, out, err = rigid("calibrate", *toy_options, *given)
    assert code == 0
    assert "warning" not in err
    assert (heard["iterations"], heard["seeds"]) == (5, (3, 4))
    assert heard["run"] == tmp_path / "r.run"
    assert out == said(FOUND, tmp_path / "r.json") + "\n"
    assert "adversarialness 0 at a return of 2, 1 at -8" in out


@pytest.mark.parametrize(("sabotage", "far"), [(-42.9, False), (-43.1, True)])
def test_sabotage_ten_times_beyond_canonical_play_is_warned_of_with_a_nearer_range(sabotage, far):
    spread = {"mean": -3.0, "quantiles": {"0.05": -5.0, "0.95": -1.0}}
    warning = too_far({"returns": {"canonical": spread, "sabotage": {"mean": sabotage}}})
    assert (warning is not None) == far
    if far:
        assert "10 times what canonical returns reach themselves (4)" in warning
        assert warning.endswith("--return-range=-39,-3")


def test_no_iterations_make_no_calibration(rigid, toy_options, tmp_path):
    code, _, err = rigid("calibrate", *toy_options, "--iterations", 0, "--out", tmp_path / "r.json")
    assert code == 2
    assert "--iterations is 0, but must be at least 1" in err
