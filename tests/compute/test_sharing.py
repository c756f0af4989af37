"""A measurement whose adversaries share networks: all the rest of the pipeline holds."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from rigid.compute.budget import stored_preset
from rigid.learning.conditioned import Sharing
from rigid.policies.loading import load_policy
from tests.compute.tiny import TINY, FilmedReach, Notes, measure_tiny, without_times

SHARED = replace(
    TINY, name="tiny-shared", seeds=(0,), per_round=(3,), lambda_min=0.05,
    sharing=Sharing(wild_slots=2, natural_slots=3),
)  # fmt: skip
STEPS = SHARED.iterations * SHARED.episodes * FilmedReach().horizon


@pytest.fixture(scope="module")
def shared(base, tmp_path_factory):
    notes = Notes()
    out = tmp_path_factory.mktemp("shared") / "run"
    return measure_tiny(base, out, preset=SHARED, listener=notes), notes


def test_steps_are_those_of_the_slots_however_many_lambdas_there_are(shared):
    frontier, notes = shared
    spent = [point["env_steps"] for point in frontier.points]
    planned = SHARED.env_steps(FilmedReach().horizon)
    assert sum(spent) == 5 * STEPS == notes.work.training_steps == planned
    assert notes.complete
    assert max(spent) - min(spent) <= 1


def test_more_lambdas_train_no_longer(base, tmp_path):
    notes = Notes()
    measure_tiny(
        base, tmp_path / "run", preset=SHARED, lambdas=(0.0, 0.05, 0.5, 1.0, 2.0), listener=notes
    )
    assert notes.work.training_steps == 5 * STEPS
    assert notes.complete


def test_each_adversary_is_an_ordinary_policy_with_a_judge_of_its_own(shared):
    frontier, _ = shared
    task = FilmedReach()
    for point in frontier.points:
        directory = frontier.directory / "adversaries" / point["id"]
        assert load_policy(str(directory), task=task, agent="human").observation_size == 3
        assert 0 <= point["naturalness_own"] <= 1
    told = json.loads((frontier.directory / "discriminators" / "s0.json").read_text())
    assert set(told["judged"]) == {point["id"] for point in frontier.points}


def test_an_interrupted_measurement_goes_on_to_the_same_numbers(shared, base, tmp_path):
    frontier, _ = shared
    stopping = Notes()
    stopping._stop = lambda: stopping.done > 3 * STEPS
    with pytest.raises(KeyboardInterrupt):
        measure_tiny(base, tmp_path / "run", preset=SHARED, listener=stopping)
    resumed = measure_tiny(base, tmp_path / "run", preset=SHARED)
    assert without_times(resumed) == without_times(frontier)


def test_a_run_that_was_begun_keeps_its_sharing(shared):
    frontier, _ = shared
    assert stored_preset(frontier.directory, TINY) == SHARED
