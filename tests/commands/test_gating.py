"""`rigid gate` on the toy measurement."""

from __future__ import annotations

import json
import shutil

import pytest

from rigid.frontier.intervals import t_interval, upper_bound


def test_the_gate_opens_when_every_upper_bound_keeps_its_limit(rigid, two_runs):
    code, out, _ = rigid("gate", two_runs[0], "--max-worst", "1", "--max-auc", "1")
    assert code == 0
    assert [line[:6] for line in out.splitlines()[:3]] == ["ok    ", "ok    ", "upper "]


def test_a_gate_that_few_seeds_open_warns_of_luck(rigid, with_worst):
    luck = "search seeds may agree by chance, and let a robot pass by luck: rely on 5 or more"

    def said(directory, *options):
        return " ".join(rigid("gate", directory, *options)[1].split())

    assert f"4 {luck}" in said(with_worst(0.1, 0.1, 0.1, 0.11), "--max-worst", "0.4")


def test_a_gate_that_stays_shut_or_has_seeds_enough_warns_of_no_luck(rigid, with_worst):
    few = with_worst(0.5, 0.6)
    assert "luck" not in rigid("gate", few, "--max-worst", "0.4")[1]
    shutil.rmtree(few)
    many = with_worst(0.1, 0.1, 0.1, 0.1, 0.11)
    assert "luck" not in rigid("gate", many, "--max-worst", "0.4")[1]


def test_the_gate_says_where_no_natural_human_was_found(rigid, two_runs, tmp_path):
    """All humans stand at naturalness 0.5."""
    copy = shutil.copytree(two_runs[0], tmp_path / "half-natural")
    data = json.loads((copy / "frontier.json").read_text())
    data["points"] = [{**point, "naturalness": 0.5} for point in data["points"]]
    (copy / "frontier.json").write_text(json.dumps(data))

    def said(*options):
        return " ".join(rigid("gate", copy, *options)[1].split())

    text = f"{copy}: 0 of 2 seeds found a human at naturalness ≥ 0.6: in both canonical play"
    level = ("--at-naturalness", "0.6")
    assert text in said("--max-worst", "1", *level)
    assert text in said("--baseline", two_runs[0], *level)
    assert "canonical play" not in said("--max-worst", "1", "--at-naturalness", "0.4")
    assert "canonical play" not in said("--max-auc", "1", *level)


def test_the_gate_shuts_with_3_at_an_upper_bound_beyond_its_limit(rigid, two_runs, small_run):
    mean, bound = small_run.auc, upper_bound(list(small_run.data["auc_by_seed"].values()))
    assert mean < bound
    code, out, _ = rigid("gate", two_runs[0], "--max-auc", (mean + bound) / 2)
    assert code == 3
    assert out.startswith(f"FAILED  AUC: {mean:.3f}, upper bound {bound:.3f}, limit ")


def test_the_natural_end_has_a_limit_of_its_own(rigid, two_runs, small_run):
    mean = small_run.data["auc_natural"]
    code, out, _ = rigid("gate", two_runs[0], "--max-auc-natural", mean / 2)
    assert code == 3
    assert out.startswith(f"FAILED  mean over [0.8, 1]: {mean:.3f}, upper bound ")
    assert rigid("gate", two_runs[0], "--max-auc-natural", 1)[0] == 0


@pytest.fixture
def with_worst(small_run, tmp_path):
    """Makes the toy measurement one whose seeds found these worst humans at naturalness 0.9."""

    def changed(*worst):
        directory = tmp_path / "seeds"
        shutil.copytree(small_run.directory, directory)
        data = json.loads((directory / "frontier.json").read_text())
        data["points"] = [
            {**data["points"][0], "id": f"s{seed}", "seed": seed}
            | {"naturalness": 0.9, "adversarialness": height, "faults": 0}
            for seed, height in enumerate(worst)
        ]
        data["auc_by_seed"] = {str(seed): 0.5 for seed in range(len(worst))}
        data["canonical"]["adversarialness"] = 0.0
        (directory / "frontier.json").write_text(json.dumps(data))
        return directory

    return changed


SKEWED, SYMMETRIC = (0.01, 0.02, 0.06), (0.5, 0.55, 0.6)


def test_seeds_skewed_towards_0_that_t_would_let_pass_fail(rigid, with_worst):
    assert t_interval(SKEWED).high < 0.1
    code, out, _ = rigid("gate", with_worst(*SKEWED), "--max-worst", "0.1")
    assert code == 3
    assert out.splitlines() == [
        "FAILED  worst at naturalness ≥ 0.9: 0.030, upper bound 0.228, limit 0.1",
        "        (t of the logit; t: 0.096)",
        "upper bounds: 95 % over search seeds; of t and t of the logit the larger, since",
        "  t alone promises too much where seeds are skewed towards 0",
        "more search seeds narrow a bound: `rigid frontier` with the same --out and more",
        "  --seeds adds them",
    ]


def test_more_seeds_are_advised_only_where_they_could_open_the_gate(rigid, with_worst):
    directory = with_worst(*SYMMETRIC)
    assert "more search seeds" not in rigid("gate", directory, "--max-worst", "0.5")[1]
    assert "more search seeds" not in rigid("gate", directory, "--max-worst", "0.99")[1]


def test_symmetric_seeds_in_the_middle_are_held_by_t(rigid, with_worst):
    high = t_interval(SYMMETRIC).high
    code, out, _ = rigid("gate", with_worst(*SYMMETRIC), "--max-worst", high + 1e-6)
    assert code == 0
    assert f"0.550, upper bound {high:.3f}, limit" in out
    assert "(t)" in out


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
    assert "worst at ≥ 0 minus baseline: " in out
    assert "limit 0 (paired t)" in " ".join(out.split())
    assert "of the logit" not in out
    assert rigid("gate", worse, "--baseline", better, "--margin", "1", *options)[0] == 0


def test_a_single_seed_never_passes(rigid, single_run):
    code, out, _ = rigid("gate", single_run.directory, "--max-worst", "1")
    assert code == 3
    assert "from one seed has no upper bound; add --seeds" in " ".join(out.split())


BAD = {
    "no limit": ((), "name a limit: --max-worst, --max-auc-natural, --max-auc or --baseline"),
    "level": (("--max-worst", "1", "--at-naturalness", "2"), "--at-naturalness is 2.0, but must"),
}


@pytest.mark.parametrize(("options", "message"), BAD.values(), ids=BAD)
def test_a_gate_without_sense_exits_with_2(rigid, two_runs, options, message):
    code, _, err = rigid("gate", two_runs[0], *options)
    assert code == 2
    assert message in err
