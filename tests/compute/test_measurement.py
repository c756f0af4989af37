"""A measurement from robot to run directory: what it writes, and what it refuses."""

from __future__ import annotations

import json
import math
import shutil
from dataclasses import replace

import pytest

from rigid.compute.executors.executor import Local
from rigid.compute.measurement import measure_each
from rigid.compute.preparation import lambdas_of, seeds_of, settings_for
from rigid.compute.robot_run import Order
from rigid.compute.subject import Subject
from rigid.data.episodes import data_hash, save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.frontier.result import load_frontier
from rigid.policies.native import load_native
from tests.compute.schema import FrontierFile
from tests.compute.tiny import TINY, FilmedReach, Notes, without_times

IDS = [f"s{seed}-{member}" for seed in (0, 1) for member in ("r1-l1", "r1-l2", "r2-l1")]


def files_of(directory):
    return {path: path.stat().st_mtime_ns for path in directory.rglob("*") if path.is_file()}


def test_frontier_json_is_of_schema_1(small_run):
    text = (small_run.directory / "frontier.json").read_text(encoding="utf-8")
    FrontierFile.model_validate_json(text)


def test_point_ids_say_seed_round_and_place_among_the_lambdas(small_run):
    assert [point["id"] for point in small_run.points] == IDS


def test_every_point_counts_its_training_steps(small_run):
    horizon = FilmedReach().horizon
    assert {p["env_steps"] for p in small_run.points} == {TINY.iterations * TINY.episodes * horizon}
    assert small_run.data["env_steps"] == TINY.env_steps(horizon)


def test_the_second_round_lies_between_two_lambdas_of_the_first(small_run):
    for low, high, refined in (small_run.points[:3], small_run.points[3:]):
        assert low["lambda"] < refined["lambda"] < high["lambda"]


def test_the_run_directory_is_laid_out_as_promised(small_run):
    directory = small_run.directory
    names = {path.name for path in directory.iterdir() if path.is_file()}
    assert names == {"settings.json", "frontier.json", "report.html"}
    referees = {f"{name}.{end}" for name in IDS for end in ("json", "safetensors")}
    assert {path.name for path in (directory / "referee").iterdir()} == referees
    stored = {"policy.safetensors", "policy.json", "discriminator.safetensors", "metrics.jsonl",
              "episodes.npz"}  # fmt: skip
    for name in IDS:
        assert {path.name for path in (directory / "adversaries" / name).iterdir()} == stored


def test_checkpoints_are_gone_when_a_group_is_done(small_run):
    assert not list(small_run.directory.rglob("groups/*.safetensors"))


def test_an_adversary_can_be_loaded_and_knows_its_lambda(small_run):
    for point in small_run.points:
        policy, card = load_native(small_run.directory / "adversaries" / point["id"])
        assert card.agent == "human"
        assert card.provenance["lambda"] == point["lambda"]
        assert policy.observation_size == FilmedReach().human.observation_size


def test_adversaries_with_memory_are_stored_with_it(measure, tmp_path):
    frontier = measure(tmp_path / "run", seeds=[0], lambdas=[1.0], memory=3)
    policy, _ = load_native(frontier.directory / "adversaries" / "s0-r1-l1")
    assert policy.memory == 3
    assert policy.observation_size == FilmedReach().human.observation_size


def test_metrics_hold_one_json_line_for_each_iteration(small_run):
    text = (small_run.directory / "adversaries" / IDS[0] / "metrics.jsonl").read_text()
    rows = [json.loads(line) for line in text.splitlines()]
    assert [row["iteration"] for row in rows] == list(range(TINY.iterations))


def test_settings_resolve_everything(small_run):
    settings = json.loads((small_run.directory / "settings.json").read_text())
    assert settings["seeds"] == [0, 1]
    assert settings["identity"]["preset"]["iterations"] == TINY.iterations
    assert {"task", "robot", "human", "canonical", "measure", "features"} <= set(
        settings["identity"]
    )
    assert {"command", "versions", "git_commit"} <= set(settings["provenance"])


def test_numbers_of_a_seed_do_not_depend_on_other_seeds(small_run, single_run):
    def facts(points):
        return [{**point, "on_frontier": None} for point in points]

    assert facts(single_run.points) == facts(small_run.points[:3])


def test_a_seed_added_later_gives_what_both_at_once_give(small_run, single_copy, measure):
    outdated = [single_copy / name for name in ("report.html", "failures.json")]
    for file in outdated:
        file.write_text("of one seed")
    notes = Notes()
    grown = measure(single_copy, seeds=[1], listener=notes)
    assert without_times(grown) == without_times(small_run)
    assert not any(file.exists() for file in outdated)
    assert notes.work.training_steps == small_run.data["env_steps"]
    assert notes.work.done == notes.work.steps / 2
    assert notes.complete


def test_time_of_earlier_sessions_counts(single_copy, measure):
    before = load_frontier(single_copy).data
    (single_copy / "frontier.json").unlink()
    after = measure(single_copy, seeds=[0]).data
    assert after["core_seconds"] > before["core_seconds"]
    assert after["wall_seconds"] > before["wall_seconds"]


def test_a_finished_measurement_is_left_untouched(single_copy, measure):
    before, notes = files_of(single_copy), Notes()
    frontier = measure(single_copy, seeds=[0], listener=notes)
    assert notes.lines[1:] == [f"{single_copy} is already complete; nothing to do"]
    assert files_of(single_copy) == before
    assert frontier.data == load_frontier(single_copy).data


def test_other_settings_are_refused_with_the_first_difference(single_copy, measure):
    before = files_of(single_copy)
    message = r"other settings: preset\.scoring_episodes is 6 there and 7 here \(preset or budget"
    with pytest.raises(UserError, match=message):
        measure(single_copy, seeds=[0], preset=replace(TINY, scoring_episodes=7))
    assert files_of(single_copy) == before


def test_lambdas_that_differ_in_the_last_digit_are_other_settings(measure, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        measure(tmp_path / "run", seeds=[0], lambdas=[0.1], listener=Notes(stop=lambda: True))
    with pytest.raises(UserError, match=r"lambdas is \[0\.1\] there and \[0\.1000000001\] here"):
        measure(tmp_path / "run", seeds=[0], lambdas=[0.1000000001])


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda path: path.write_bytes(path.read_bytes()[:-20]), r"s0-r2\.json is damaged \("),
        (lambda path: path.write_text('{"points": []}'), r"holds the points \[\], not \['s0-r2-l1"),
    ],
    ids=["truncated", "of other adversaries"],
)
def test_a_damaged_group_is_named(damage, message, single_copy, measure):
    (single_copy / "frontier.json").unlink()
    damage(single_copy / "groups" / "s0-r2.json")
    with pytest.raises(UserError, match=rf"{message}.*delete it to train its group again"):
        measure(single_copy, seeds=[0])


def test_a_group_that_was_deleted_is_trained_again(single_run, single_copy, measure):
    for name in ("frontier.json", "groups/s0-r2.json"):
        (single_copy / name).unlink()
    assert without_times(measure(single_copy, seeds=[0])) == without_times(single_run)


@pytest.mark.usefixtures("hasty_referees")
def test_of_several_robots_each_is_complete_before_the_next_is_taken(single_run, base, tmp_path):
    outs, taken = [tmp_path / name for name in "ab"], []

    def orders():
        for out in outs:
            shutil.copytree(single_run.directory, out)
            (out / "frontier.json").unlink()
            taken.append(out)
            yield Order(
                subject=subject, preset=TINY, settings=settings_for(TINY), out=out, seeds=[0]
            )

    players = (str(base / "pair" / agent) for agent in ("robot", "human"))
    subject = Subject(FilmedReach(), *players)
    for number, order in enumerate(measure_each(orders(), Local()), 1):
        assert taken == outs[:number]
        assert order.out == outs[number - 1]
        assert load_frontier(order.out).points == single_run.points
    assert taken == outs


def test_a_damaged_frontier_is_named_and_deleting_it_helps(single_run, single_copy, measure):
    path = single_copy / "frontier.json"
    path.write_bytes(path.read_bytes()[:100])
    notes = Notes()
    with pytest.raises(UserError, match=r"frontier\.json is damaged: delete it and run"):
        measure(single_copy, seeds=[0], listener=notes)
    assert "complete" not in "".join(notes.lines)
    path.unlink()
    assert without_times(measure(single_copy, seeds=[0])) == without_times(single_run)


def test_a_task_without_a_range_is_refused_before_anything_is_written(measure, tmp_path):
    with pytest.raises(UserError, match=r"'toy-reach' has no range of adversarialness: set its"):
        measure(tmp_path / "run", task=FilmedReach(return_range=None))
    assert not (tmp_path / "run").exists()


def test_episodes_that_lie_beside_the_robot_are_its_canonical_ones(measure, base, tmp_path):
    task, robot = FilmedReach(), shutil.copytree(base / "pair" / "robot", tmp_path / "robot")
    players = (load_native(base / "pair" / agent).policy for agent in ("robot", "human"))
    episodes = record(task, *players, episodes=3, seed=5, provenance={})
    save_episodes(robot / "canonical.npz", episodes)
    with pytest.raises(KeyboardInterrupt):
        measure(tmp_path / "run", robot=str(robot), listener=Notes(stop=lambda: True))
    stored = json.loads((tmp_path / "run" / "settings.json").read_text())
    assert stored["identity"]["canonical"] == data_hash(episodes)


@pytest.mark.parametrize("seeds", [[], [0, 0], [-1]])
def test_seeds_that_make_no_search_are_refused(seeds):
    with pytest.raises(UserError, match=r"seeds must be distinct and not negative, got \["):
        seeds_of(TINY, seeds)


@pytest.mark.parametrize("lambdas", [[], [0.1, 0.1], [-1.0], [math.nan]])
def test_lambdas_that_make_no_search_are_refused(lambdas):
    with pytest.raises(UserError, match=r"lambdas must be distinct, each 0 or more or inf, got \["):
        lambdas_of(lambdas)
