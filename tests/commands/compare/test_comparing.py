"""`rigid compare` on the toy measurement."""

from __future__ import annotations

import json

import pytest

from tests.frontier.samples import store


def test_compare_shows_every_robot_and_its_difference_to_the_first(rigid, two_runs, monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    code, out, err = rigid("compare", *two_runs)
    assert (code, err) == (0, "")
    titles = [
        out.index(title) for title in ("worst at ≥ 0.9", "hull at 0.9", "mean over [0.8, 1]", "AUC")
    ]
    assert titles == sorted(titles)
    assert f"minus {two_runs[0].name}, on the search seeds that both have" in out
    assert sum(line.startswith("worse") for line in out.splitlines()) == 2
    assert "a repeat of " in out


def test_compare_says_by_which_number_to_tell_robots_apart(rigid, two_runs):
    out = rigid("compare", *two_runs)[1]
    said = (
        "hull at 0.9 tells robots apart more steadily: 95 % intervals of its differences covered "
        "94 to 96 %, those of worst at ≥ 0.9 76 to 87 % (results/coverage)"
    )
    assert said in " ".join(out.split())


def test_compare_as_json_has_numbers_intervals_and_differences(rigid, two_runs):
    code, out, _ = rigid("compare", *two_runs, "--json")
    first, second = json.loads(out)
    assert code == 0
    assert first["auc"]["minus_baseline"] is None
    assert second["auc"]["minus_baseline"]["mean"] > 0
    low, high = second["auc"]["interval"]
    assert low <= second["auc"]["mean"] <= high
    assert set(second["auc"]["by_seed"]) == {"0", "1"}


def test_compare_as_json_has_the_hull_beside_the_headline_numbers(rigid, two_runs):
    first, second = json.loads(rigid("compare", *two_runs, "--json")[1])
    means = [robot["hull_at"]["mean"] for robot in (first, second)]
    assert second["hull_at"]["minus_baseline"]["mean"] == pytest.approx(means[1] - means[0])
    assert means[1] > means[0]
    assert list(first["hull_at"]) == list(first["worst_at"])


def test_compare_takes_two_or_more(rigid, two_runs):
    code, _, err = rigid("compare", two_runs[0])
    assert (code, err) == (
        2,
        "rigid: compare takes two or more: run directories, or --robots to be measured\n",
    )


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


@pytest.fixture
def methods(tmp_path):
    """Two methods of two robots each; every adversary of the second does 0.2 less harm."""
    runs = {
        name: store(tmp_path / name, heights, human=f"h{name[-1]}")
        for name, heights in {
            "v-0": {0: 0.5, 1: 0.6}, "v-1": {0: 0.4, 1: 0.5}, "r-0": {0: 0.3, 1: 0.4},
            "r-1": {0: 0.2, 1: 0.3},
        }.items()
    }  # fmt: skip
    return f"vanilla={runs['v-0']},{runs['v-1']}", f"robust={runs['r-0']},{runs['r-1']}"


def test_methods_have_a_row_each_with_intervals_over_robots_and_seeds(rigid, methods):
    code, out, err = rigid("compare", *methods)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[2].split()[:3] == ["vanilla", "1.00", "0.500"]
    assert lines[7] == "minus vanilla, on the robots and search seeds that both have"
    assert lines[10].split()[:2] == ["robust", "-0.200"]
    assert lines[11].split()[:2] == ["[-0.200,", "-0.200]"]
    assert lines[15].split() == ["robust", "1.00", "[0.96,", "1.00]", "2", "2"]
    assert "95 % intervals over robots and search seeds" in out


LONG = "a-robot-whose-name-says-all-of-how-it-was-trained"


@pytest.mark.parametrize("width", [None, 120, 80, 60, 40])
def test_nothing_is_wider_than_the_terminal(rigid, methods, two_runs, tmp_path, monkeypatch, width):
    """One that says nothing of its width, or is none, has 80 columns."""
    monkeypatch.delenv("COLUMNS", raising=False)
    if width is not None:
        monkeypatch.setenv("COLUMNS", str(width))
    long = store(tmp_path / LONG, {0: 0.5, 1: 0.9})
    for given in (methods, two_runs, (*methods, long)):
        out = rigid("compare", *given)[1]
        assert max(len(line) for line in out.splitlines()) <= (width or 80)


@pytest.mark.parametrize("width", [120, 80, 60])
def test_names_fold_and_numbers_stay_whole(rigid, methods, tmp_path, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", str(width))
    long = store(tmp_path / LONG, {0: 0.5, 1: 0.9})
    numbers = rigid("compare", methods[0], long)[1].partition("\n\n")[0]
    names = [line.split("  ")[0] for line in numbers.splitlines() if line[0] != " "]
    assert LONG in "".join(names)
    assert "[0.000, 1.000]" in numbers


def test_a_wide_terminal_shows_intervals_beside_their_numbers(rigid, methods, monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    lines = rigid("compare", *methods)[1].splitlines()
    assert lines[1].startswith("vanilla     1.00  0.500 [")
    assert lines[6].startswith("robust  -0.200 [-0.200, -0.200]")


def test_where_no_seed_found_a_natural_human_the_robot_is_named(rigid, two_runs):
    data = json.loads((two_runs[1] / "frontier.json").read_text())
    data["points"] = [{**point, "naturalness": 0.5} for point in data["points"]]
    (two_runs[1] / "frontier.json").write_text(json.dumps(data))
    out = rigid("compare", *two_runs)[1]
    said = (
        "worse: 0 of 2 seeds found a human at naturalness ≥ 0.9: in both canonical play "
        "stands there"
    )
    assert said in " ".join(out.split())
    found = json.loads(rigid("compare", *two_runs, "--json")[1])
    assert found[1]["seeds_found"] == {"0.9": 0}


def test_robots_that_pair_by_order_alone_are_named(rigid, methods):
    robust = f"robust={','.join(methods[1].removeprefix('robust=').split(',')[::-1])}"
    out = rigid("compare", methods[0], robust)[1]
    said = "robot 1 of robust was measured with another synthetic human than robot 1 of vanilla"
    assert said in " ".join(out.split())


def test_methods_as_json_have_their_robots(rigid, methods):
    vanilla, robust = json.loads(rigid("compare", *methods, "--json")[1])
    assert (robust["method"], robust["robot_seeds"], robust["search_seeds"]) == ("robust", 2, 2)
    assert robust["worst_at"]["minus_baseline"]["mean"] == pytest.approx(-0.2)
    assert vanilla["worst_at"]["minus_baseline"] is None
    assert [robot["worst_at"]["by_seed"] for robot in robust["robots"]] == [
        {"0": 0.3, "1": 0.4}, {"0": 0.2, "1": 0.3},
    ]  # fmt: skip
    assert "unseen" not in robust


def test_files_are_written_and_named(rigid, methods, tmp_path):
    names = {"csv": "t.csv", "latex": "t.tex", "figure": "f.svg", "page": "p.html"}
    places = {option: tmp_path / "new" / name for option, name in names.items()}
    code, out, _ = rigid(
        "compare", *methods, *(word for o, path in places.items() for word in (f"--{o}", path))
    )
    assert code == 0
    assert out.splitlines()[-4:] == [f"written: {path}" for path in places.values()]
    begins = [path.read_text()[:8] for path in places.values()]
    assert begins == ["method,w", r"\begin{t", "<?xml ve", "<!doctyp"]


def test_json_stays_alone_on_standard_output(rigid, methods, tmp_path):
    out = rigid("compare", *methods, "--json", "--csv", tmp_path / "t.csv")[1]
    assert len(json.loads(out)) == 2
    assert (tmp_path / "t.csv").exists()


@pytest.fixture
def own_task(toys, monkeypatch):
    """The toy task counts as RIGID's own; returns the folder of the toy pair."""
    from rigid.tasks import registry
    from tests.compute.tiny import FilmedReach

    recipe = registry._Recipe(FilmedReach, None)
    monkeypatch.setitem(registry._BUILTIN, "toy-reach", lambda: recipe)
    return toys


def test_unseen_humans_get_a_column_everywhere(rigid, two_runs, own_task, tmp_path):
    options = ("--humans", own_task / "human", "builtin:passive", "--episodes", "5")
    code, out, _ = rigid("compare", *two_runs, *options, "--csv", tmp_path / "t.csv")
    assert code == 0
    assert "unseen humans  robots  search seeds" in out
    header, first, _ = (tmp_path / "t.csv").read_text().splitlines()
    assert header.endswith(",search_seeds,unseen,unseen_low,unseen_high")
    found = json.loads(rigid("compare", *two_runs, *options, "--json")[1])[0]
    assert f"{found['unseen']:.4g}" == first.split(",")[-3]
    low, high = found["unseen_interval"]
    assert low <= found["unseen"] <= high


BAD = {
    "episodes alone": (("--episodes", "5"), "--episodes is for --humans: name the humans"),
    "no episodes": (("--humans", "x", "--episodes", "0"), "--episodes is 0, but must be at least"),
    "figure": (("--figure", "f.gif"), "--figure 'f.gif': its ending must be .svg or .pdf or .png"),
    "page": (("--page", "p.pdf"), "--page 'p.pdf': its ending must be .html"),
    "place": (("--csv", "/proc/t.csv"), "choose another place with --csv"),
    "human": (("--humans", "nobody"), "human 'nobody' is no directory"),
}


@pytest.mark.parametrize(("options", "message"), BAD.values(), ids=BAD)
def test_what_does_not_go_together_exits_with_2(rigid, two_runs, own_task, options, message):
    del own_task
    code, _, err = rigid("compare", *two_runs, *options)
    assert code == 2
    assert message in err


def test_methods_that_were_measured_otherwise_are_refused(rigid, methods, tmp_path):
    other = store(tmp_path / "other", {0: 0.1}, identity={"preset": {"iterations": 9}})
    code, _, err = rigid("compare", methods[0], f"robust={other}")
    assert code == 2
    assert "cannot be compared: preset.iterations is 40 for the one and 9 for the other" in err
