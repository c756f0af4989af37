"""`rigid compare` and `rigid gate` on the toy measurement."""

from __future__ import annotations

import json
import shutil

import pytest


@pytest.fixture
def two_runs(small_run, tmp_path):
    """The toy measurement, and one of a robot that fares worse by a fifth with every human."""
    worse = tmp_path / "worse"
    shutil.copytree(small_run.directory, worse)
    data = json.loads((worse / "frontier.json").read_text())
    for point in data["points"]:
        point["adversarialness"] = min(point["adversarialness"] + 0.2, 1.0)
    (worse / "frontier.json").write_text(json.dumps(data))
    return small_run.directory, worse


def test_compare_shows_every_robot_and_its_difference_to_the_first(rigid, two_runs):
    code, out, err = rigid("compare", *two_runs)
    assert (code, err) == (0, "")
    assert "worst at ≥ 0.9" in out
    assert f"minus {two_runs[0].name}, on the search seeds that both have" in out
    assert sum(line.startswith("worse") for line in out.splitlines()) == 2
    assert "a repeat of " in out


def test_compare_as_json_has_numbers_intervals_and_differences(rigid, two_runs):
    code, out, _ = rigid("compare", *two_runs, "--json")
    first, second = json.loads(out)
    assert code == 0
    assert first["auc"]["minus_baseline"] is None
    assert second["auc"]["minus_baseline"]["mean"] > 0
    low, high = second["auc"]["interval"]
    assert low <= second["auc"]["mean"] <= high
    assert set(second["auc"]["by_seed"]) == {"0", "1"}


def test_compare_takes_two_or_more(rigid, two_runs):
    code, _, err = rigid("compare", two_runs[0])
    assert (code, err) == (2, "rigid: compare takes two run directories or more\n")


def test_compare_refuses_the_same_directory_twice(rigid, two_runs):
    code, _, err = rigid("compare", two_runs[0], two_runs[0])
    assert code == 2
    assert "the same run directory twice" in err


def test_a_strangers_text_cannot_steer_the_terminal(rigid, two_runs):
    settings = two_runs[1] / "settings.json"
    stored = json.loads(settings.read_text())
    stored["identity"]["measure"] = "\x1b[2J"
    settings.write_text(json.dumps(stored))
    code, _, err = rigid("compare", *two_runs)
    assert code == 2
    assert r"\x1b[2J" in err
    assert "\x1b" not in err


def test_the_gate_opens_when_every_upper_bound_keeps_its_limit(rigid, two_runs):
    code, out, _ = rigid("gate", two_runs[0], "--max-worst", "1", "--max-auc", "1")
    assert code == 0
    assert [line[:6] for line in out.splitlines()] == ["ok    ", "ok    "]


def test_the_gate_shuts_with_3_at_an_upper_bound_beyond_its_limit(rigid, two_runs, small_run):
    mean, (_, high) = small_run.auc, small_run.auc_interval
    assert mean < high
    code, out, _ = rigid("gate", two_runs[0], "--max-auc", (mean + high) / 2)
    assert code == 3
    assert out.startswith(f"FAILED  AUC: {mean:.3f}, upper bound {high:.3f}, limit ")


def test_the_gate_looks_from_the_naturalness_that_was_asked_for(rigid, two_runs, small_run):
    worst = [p["adversarialness"] for p in small_run.points if p["seed"] == 0]
    code, out, _ = rigid("gate", two_runs[0], "--max-worst", "0", "--at-naturalness", "0")
    assert code == 3
    assert max(worst) > 0
    assert "worst at naturalness ≥ 0: " in out


def test_a_robot_that_became_worse_fails_against_its_baseline(rigid, two_runs):
    better, worse = two_runs
    options = ("--at-naturalness", "0")
    assert rigid("gate", better, "--baseline", better, *options)[0] == 0
    code, out, _ = rigid("gate", worse, "--baseline", better, *options)
    assert code == 3
    assert "worst at naturalness ≥ 0, minus the baseline's" in out
    assert rigid("gate", worse, "--baseline", better, "--margin", "1", *options)[0] == 0


def test_a_single_seed_never_passes(rigid, single_run):
    code, out, _ = rigid("gate", single_run.directory, "--max-worst", "1")
    assert code == 3
    assert "from one seed has no upper bound; add --seeds" in out


BAD = {
    "no limit": ((), "name a limit: --max-worst, --max-auc or --baseline"),
    "level": (("--max-worst", "1", "--at-naturalness", "2"), "--at-naturalness is 2.0, but must"),
}


@pytest.mark.parametrize(("options", "message"), BAD.values(), ids=BAD)
def test_a_gate_without_sense_exits_with_2(rigid, two_runs, options, message):
    code, _, err = rigid("gate", two_runs[0], *options)
    assert code == 2
    assert message in err
