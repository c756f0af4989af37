"""`rigid train`: which directories it fills, and which numbers it refuses."""

from __future__ import annotations

import io

import numpy as np
import pytest
from rich.console import Console

from rigid.cli import run
from rigid.commands.terminal import progress
from rigid.commands.train.progress import show_progress, show_stages
from rigid.learning.cooptimisation import CoOptimisationSettings, Progress
from rigid.learning.personalisation import PersonalisationSettings
from rigid.robots.gleave import GleaveSettings
from rigid.robots.palm import PalmRecipe
from rigid.robots.robust_gt import RobustSettings
from tests.toys import ToyReach


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["co-optimize", "--iterations", "0"], "--iterations is 0, but must be at least 1"),
        (["co-optimize", "--seed=-1"], "--seed is -1, but must be at least 0"),
        (["vanilla", "--pair", "p", "--iterations", "0"], "--iterations is 0"),
        (["vanilla", "--pair", "p", "--memory", "0"], "--memory is 0, but must be at least 1"),
        (["vanilla", "--pair", "p", "--episodes", "0"], "--episodes is 0"),
        (["vanilla", "--pair", "nowhere"], "nowhere holds no human/: give a directory of `rigid"),
        (["gleave", "--pair", "p", "--population-iterations", "0"], "--population-iterations is 0"),
        (["gleave", "--pair", "nowhere"], "nowhere holds no human/: give a directory of `rigid"),
        (["palm", "--pair", "p", "--diverse-iterations", "0"], "--diverse-iterations is 0, but"),
        (["palm", "--pair", "p"], "'toy-reach' does not say which of the robot's observations"),
        (["co-optimize", "--task", "toy-rich"], "unknown task 'toy-rich', did you mean"),
    ],
)
def test_bad_input_exits_with_2_and_writes_nothing(rigid, toys, tmp_path, options, message):
    del toys
    task = [] if "--task" in options else ["--task", "toy-reach"]
    code, out, err = rigid("train", *options, *task, "--out", tmp_path / "new")
    assert (code, out) == (2, "")
    assert message in err
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--from", "nowhere"], "there is no directory nowhere: name a run of `rigid frontier`"),
        (["--from", "r", "--rounds", "0"], "--rounds is 0, but must be at least 1"),
        (["--from", "r", "--share", "1"], "--share is 1, but must lie between 0 and 1"),
        (["--from", "r", "--naturalness", "0.8", "0.2"], "--naturalness 0.8 0.2 must be LOW HIGH"),
        (["--from", "r", "--adversaries", "0"], "--adversaries is 0, but must be at least 1"),
    ],
)
def test_robust_gt_refuses_bad_input_and_writes_nothing(rigid, tmp_path, options, message):
    code, out, err = rigid("train", "robust-gt", *options, "--out", tmp_path / "new")
    assert (code, out) == (2, "")
    assert message in err
    assert not (tmp_path / "new").exists()


def test_robust_gt_trains_on_and_names_a_search_that_no_training_saw(
    rigid, toys, single_run, tmp_path, monkeypatch
):
    from rigid.tasks import registry
    from tests.compute.tiny import FilmedReach

    recipe = registry._Recipe(FilmedReach, None)
    monkeypatch.setitem(registry._BUILTIN, "toy-reach", lambda: recipe)
    code, out, err = rigid(
        "train", "robust-gt", "--from", single_run.directory, "--iterations", 1,
        "--naturalness", 0, 1, "--out", tmp_path / "robust",
    )  # fmt: skip
    assert code == 0, err
    assert f"rigid frontier --robot {tmp_path / 'robust'} --human {toys / 'human'}" in out
    assert "--preset tiny --seeds 1..2" in out


def test_the_search_that_robust_gt_names_is_as_the_one_it_learned_from_and_can_be_typed(
    single_run, tmp_path
):
    import json
    import shlex
    import shutil

    from rigid.commands.train.robust import _as_searched, _typed

    run = shutil.copytree(single_run.directory, tmp_path / "run")
    assert _as_searched(run) == {}
    settings = json.loads((run / "settings.json").read_text())
    settings["identity"] |= {"features": "x,y", "measure": "kl", "lambdas": [0.1, "inf"]}
    settings["identity"]["adversary"]["memory"] = 3
    (run / "settings.json").write_text(json.dumps(settings))
    frontier = json.loads((run / "frontier.json").read_text())
    frontier |= {"range_source": "option", "return_range": [-100.0, 20.0]}
    (run / "frontier.json").write_text(json.dumps(frontier))
    asked = _typed({"robot": "my robots/a", "human": None, **_as_searched(run)})
    assert shlex.split(asked) == [
        "--robot", "my robots/a", "--features", "x,y", "--search-measure", "kl", "--memory", "3",
        "--lambdas", "0.1,inf", "--return-range=-100.0,20.0",
    ]  # fmt: skip


def test_a_place_that_cannot_be_written_exits_with_2(rigid, toys, tmp_path):
    del toys
    (tmp_path / "file").touch()
    out = tmp_path / "file" / "pair"
    code, _, err = rigid("train", "co-optimize", "--task", "toy-reach", "--out", out)
    assert code == 2
    assert "choose another place with --out" in err


def test_progress_goes_to_standard_error(capsys):
    with show_progress("co-optimising", 10) as report:
        for iteration in range(10):
            report(Progress(iteration, -3.25, 0.5, 0.1))
    out, err = capsys.readouterr()
    assert out == ""
    assert "return -3.2 · success 0.50" in err


def test_the_bar_of_a_robot_names_its_recipe(rigid, toys, tmp_path, monkeypatch):
    from rigid.robots import vanilla

    def train(task, settings, *, report, **others):
        del task, settings, others
        report(Progress(0, -3.25, 0.5, 0.1))

    monkeypatch.setattr(vanilla, "train_vanilla", train)
    options = ("--task", "toy-reach", "--pair", toys, "--out", tmp_path / "robot")
    assert "vanilla · return" in rigid("train", "vanilla", *options)[2]


def test_of_two_stages_only_the_one_that_is_under_way_has_a_running_clock():
    with show_stages(("population", 2), ("robot", 3)) as (first, second):
        one, two = first._bar.tasks
        first.begin(ToyReach(), 4, done=0)
        assert (one.elapsed is None, two.elapsed is None) == (False, True)
        first(Progress(1, 0.0, 0.5, 0.1))
        second.begin(ToyReach(), 4, done=0)
        assert second._times.render(one).plain == "0:00"
        assert two.elapsed is not None
        second(Progress(0, 0.0, 0.5, 0.1))
        assert (one.completed, two.completed) == (2, 1)


def test_a_stage_that_was_stored_earlier_is_shown_as_done():
    with show_stages(("population", 2), ("robot", 3)) as (_, second):
        second.begin(ToyReach(), 4, done=0)
        one, two = second._bar.tasks
        assert one.completed == 2
        assert two.elapsed is not None


def test_a_bar_moves_within_a_slow_iteration_and_never_beyond_it(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    task = ToyReach()
    with show_progress("co-optimising", 3) as report:
        report.begin(task, 4, done=0)
        seen, bar = report.watch(task), report._bar.tasks[0]
        world, still = seen.make_world(4), np.zeros((4, 1))
        for _ in range(2):
            world.reset(np.arange(4))
            for _ in range(task.horizon // 2):
                world.step(still, still)
            assert bar.completed == 0.5
            for _ in range(task.horizon):
                world.step(still, still)
            assert bar.completed == 0.99
            report(Progress(2, 0.0, 0.5, 0.1))
            assert bar.completed == 3
            world.step(still, still)  # As canonical episodes afterwards.
            assert bar.completed == 3
            report(Progress(-1, 0.0, 0.5, 0.1))


def test_a_training_says_how_long_it_will_take_before_its_first_iteration_is_done(capsys):
    with show_progress("co-optimising", 3) as report:
        report.begin(ToyReach(), 4, done=0)
        assert "compiling" in report._times.rest(report._bar.tasks[0])
        report(Progress(0, 0.0, 0.5, 0.1))
        assert "compiling" not in report._times.rest(report._bar.tasks[0])
    assert "co-optimising: 3 iterations of 40 steps; about 4 s" in capsys.readouterr().err


def test_what_an_earlier_call_trained_is_shown_at_once_and_says_nothing_of_the_speed(capsys):
    with show_progress("vanilla", 100) as report:
        report.begin(ToyReach(), 4, done=90)
        assert report._bar.tasks[0].completed == 90
        expected = report._pace.left(9)
        report(Progress(90, 1.0, 0.5, 0.1))
        assert report._pace.left(9) <= expected
    assert "100 iterations of 40 steps, of which 90 are done; about" in capsys.readouterr().err


def test_a_log_of_a_training_tells_the_time_left(capsys):
    with show_progress("co-optimising", 20) as report:
        for iteration in range(10):
            report(Progress(iteration, 1.0, 0.5, 0.1))
    assert "co-optimising 10/20 · return 1.0 · success 0.50 · 0 s left\n" in capsys.readouterr().err


class Heavy(ToyReach):
    """Nobody should try out how fast its worlds are."""

    most_worlds = 4

    def make_world(self, batch, *, threads=0):
        raise AssertionError(f"{batch} worlds on {threads} threads")


def test_a_task_of_heavy_worlds_is_not_tried_out(capsys):
    with show_progress("vanilla", 3) as report:
        report.begin(Heavy(), 4, done=0)
        assert report._times.rest(report._bar.tasks[0]) == ""
    assert "vanilla: 3 iterations of 40 steps\n" in capsys.readouterr().err


LENGTHS = {
    ("co-optimize", "--iterations"): CoOptimisationSettings().iterations,
    ("vanilla", "--iterations"): PersonalisationSettings().iterations,
    ("gleave", "--iterations"): GleaveSettings().personalisation.iterations,
    ("gleave", "--population-iterations"): GleaveSettings().population.iterations,
    ("palm", "--iterations"): PalmRecipe().palm.personalisation.iterations,
    ("palm", "--diverse-iterations"): PalmRecipe().diverse.iterations,
    ("robust-gt", "--iterations"): RobustSettings().training.iterations,
}


@pytest.mark.parametrize(("named", "iterations"), LENGTHS.items(), ids=map(" ".join, LENGTHS))
def test_the_help_says_how_long_a_recipe_is(named, iterations, capsys):
    recipe, option = named
    with pytest.raises(SystemExit):
        run(["train", recipe, "--help"])
    said = " ".join(capsys.readouterr().out.replace("│", "").split())
    text = said.partition(f"{option} INT ")[2].partition(" (default: ")[0]
    assert text.endswith(f"by default {iterations}.")


@pytest.mark.parametrize("what", ["co-optimising", "vanilla", "diverse pair", "round-1"])
def test_a_line_of_80_columns_holds_all_of_a_bar(what):
    console = Console(width=80, file=io.StringIO(), force_terminal=True)
    with show_progress(what, 160) as report:
        report(Progress(99, -123.4, 0.5, 0.1))
        task = report._bar.tasks[0]
        task.start_time = task.get_time() - 725.0
        console.print(report._bar)
    line = console.file.getvalue()
    for part in (what, "return -123.4 · success 0.50", "100/160", "12:05 so far"):
        assert part in line
    assert "…" not in line


def test_a_refused_training_draws_no_bar(rigid, toys, monkeypatch):
    for name in ("FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE"):
        monkeypatch.setenv(name, "1")
    options = ("--task", "toy-reach", "--pair", toys, "--out", toys / "robot")
    code, _, err = rigid("train", "vanilla", *options)
    assert code == 2
    assert "already holds a robot" in err
    assert "━" not in err
