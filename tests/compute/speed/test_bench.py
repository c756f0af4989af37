"""Speed is measured on the real task, and what is timed against each other does the same work."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from rigid import presets
from rigid.compute.speed import bench
from rigid.compute.speed.iteration_parts import Iteration, step_through
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.compute.tiny import TINY
from tests.tasks.scripted import random_actions

BRIEF = replace(TINY, seeds=(0,), per_round=(2,), iterations=2)
"""A group of two λ, each 4 episodes of 100 steps."""


@pytest.fixture
def _small(monkeypatch, iteration, single_run, hasty_referees):
    """A small preset `paper`, prepared once, hasty referees, and a toy run for the report."""
    del hasty_referees
    prepared = iteration.inputs
    monkeypatch.setattr(bench, "group_inputs", lambda _, place: replace(prepared, directory=place))
    monkeypatch.setitem(presets.PRESETS, "paper", BRIEF)
    monkeypatch.setattr("rigid.compute.speed.assistive_gym._WORLDS", 2)
    monkeypatch.setattr(bench, "small_run", lambda _: single_run)


@pytest.fixture(scope="module")
def iteration(tmp_path_factory):
    return Iteration(bench.group_inputs(BRIEF, tmp_path_factory.mktemp("bench")))


def test_the_bare_physics_goes_through_the_same_motion():
    task, rng = ItchScratching(), np.random.default_rng(0)
    world = task.make_world(6, threads=1)
    world.reset(np.arange(6))
    motion = [world.snapshot()]
    for _ in range(20):
        world.step(*random_actions(rng, 6))
        motion.append(world.snapshot())
    end = step_through(task, np.stack(motion), threads=1)
    # Snapshots are of single precision.
    np.testing.assert_allclose(end, motion[-1][:, : task.model.nq], atol=1e-3)


def test_the_stepping_part_goes_through_the_motion_that_physics_does(iteration):
    iteration.stepping()
    angles = slice(iteration.inputs.task.model.nq)
    mine, physics = iteration._world.snapshot(), iteration._motion[-1]
    np.testing.assert_allclose(mine[:, angles], physics[:, angles], atol=1e-3)


def test_only_the_whole_iteration_trains(iteration):
    before = [int(adversary.iteration) for adversary in iteration.group]
    for part in (iteration.inference, iteration.ppo, iteration.discriminator):
        part()
    assert [int(adversary.iteration) for adversary in iteration.group] == before
    iteration.whole()
    assert [int(adversary.iteration) for adversary in iteration.group] == [n + 1 for n in before]


TIMES = {
    "startup": [0.3, 0.1, 0.2],
    "physics": [1.0, 2.0, 4.0],
    "stepping": [1.5, 3.0, 5.0],
    "inference": [0.5, 0.5, 0.5],
    "whole": [4.0, 4.0, 8.0],
    "ppo": [1.0, 0.25, 1.0],
    "discriminator": [0.5, 0.25, 1.0],
    "referee": [6.0, 8.0, 7.0],
}


def test_figures_are_medians_over_turns_with_quartiles():
    found = bench.figures(TIMES, env_steps=8000, adversaries=4)
    assert found["physics_env_steps_per_s"] == 4000
    assert found["spread"]["physics_env_steps_per_s"] == [3000, 6000]
    assert found["training_env_steps_per_s"] == 2000
    assert found["discriminator_updates_per_s"] == 8.0
    assert (found["referee_s"], found["startup_s"], found["repeats"]) == (7.0, 0.2, 3)


def test_the_ratio_is_the_median_of_the_ratios_of_each_turn():
    """Of one turn, since both are slowed alike only there."""
    found = bench.figures(TIMES, env_steps=8000, adversaries=4)
    assert found["training_over_physics"] == 0.5


def test_the_budget_of_a_step_leaves_over_what_no_part_explains():
    times = {name: values[:1] for name, values in TIMES.items()}
    budget = bench.figures(times, env_steps=1_000_000, adversaries=4)["budget_per_env_step_us"]
    assert budget == {
        "physics": 1.0,
        "observation_and_reward": 0.5,
        "inference": 0.5,
        "ppo": 1.0,
        "discriminator": 0.5,
        "rest": 0.5,
        "total": 4.0,
    }


def test_a_report_that_cannot_be_drawn_is_not_measured():
    assert bench.figures(TIMES, env_steps=8000, adversaries=4)["report_s"] is None
    drawn = bench.figures({**TIMES, "report": [1.0, 3.0, 2.0]}, env_steps=8000, adversaries=4)
    assert drawn["report_s"] == 2.0


def test_without_a_front_end_there_is_no_report_to_time(monkeypatch, single_run, tmp_path):
    monkeypatch.setattr(bench, "small_run", lambda _: single_run)
    monkeypatch.setattr("rigid.report.build._PACKAGE", tmp_path)
    assert bench.report_work(tmp_path) is None


@pytest.mark.usefixtures("_small")
def test_bench_writes_what_the_contract_names_and_shows_the_last_run(capsys, tmp_path):
    from rigid.cli import run

    file = tmp_path / "latest.json"
    file.write_text('{"startup_s": 0.125}')
    assert run(["bench", "--assistive-gym", "--repeats", "1", "--json", str(file)]) == 0
    found = json.loads(file.read_text())
    for name in ("physics_env_steps_per_s", "training_env_steps_per_s", "training_over_physics",
                 "discriminator_updates_per_s", "referee_s", "report_s", "startup_s",
                 "paper_core_hours"):  # fmt: skip
        assert found[name] > 0, name
    assert found["standard_wall_s"] is None
    assert found["growth"] is None
    assert found["threads"] >= 1
    assert (found["physics_step"], found["substeps"]) == (0.02, 5)
    shown = capsys.readouterr().out
    assert "(last run: 0.125, now ×" in shown
    assert "preset standard         not measured" in shown


def test_bench_without_repeats_exits_with_2(capsys):
    from rigid.cli import run

    assert run(["bench", "--repeats", "0"]) == 2
    assert "--repeats is 0, but must be at least 1" in capsys.readouterr().err
