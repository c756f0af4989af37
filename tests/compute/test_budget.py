"""A preset that fits a time: fewer iterations first, then fewer seeds."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from rigid.compute.budget import FIXED_SECONDS, fit_to, stored_preset, training_speed
from rigid.errors import UserError
from tests.compute.tiny import TINY
from tests.toys import ToyReach

PRESET = replace(
    TINY, seeds=(0, 1, 2, 3), iterations=100, episodes=10,
    referee_episodes=1, validation_episodes=1, scoring_episodes=1,
)  # fmt: skip
HORIZON = 10


def work(preset) -> int:
    """Steps of training and scoring."""
    return preset.env_steps(HORIZON) + preset.scoring_steps(preset.adversaries, HORIZON)


FULL, SCORING = work(PRESET), PRESET.scoring_steps(PRESET.adversaries, HORIZON)


def fitted(share: float):
    """For a machine of one step in a second, time to score all, and a share of that to train."""
    seconds = FIXED_SECONDS + SCORING + share * (FULL - SCORING)
    return fit_to(PRESET, seconds, horizon=HORIZON, speed=lambda _: 1.0)


def test_enough_time_changes_nothing():
    assert fitted(1.0) == PRESET


def test_iterations_go_first():
    assert fitted(0.5) == replace(PRESET, iterations=50)


def test_a_preset_of_fewer_iterations_keeps_them():
    few = replace(PRESET, iterations=5)
    seconds = FIXED_SECONDS + work(few) / 2
    fit = fit_to(few, seconds, horizon=HORIZON, speed=lambda _: 1.0)
    assert fit == replace(few, seeds=(0, 1))


def test_seeds_go_when_twenty_iterations_are_left():
    assert fitted(0.1) == replace(PRESET, iterations=20, seeds=(0, 1))


@pytest.mark.parametrize("share", [0.06, 0.2, 0.55, 0.97])
def test_what_was_fitted_takes_no_longer_than_there_is_time(share):
    assert work(fitted(share)) <= SCORING + share * (FULL - SCORING)


def test_too_little_time_for_one_seed_is_refused_with_the_least_that_would_do():
    least = FIXED_SECONDS + work(replace(PRESET, seeds=(0,), iterations=20))
    message = rf"--budget is too short for preset 'tiny': .* about {least:.0f} s here, more than"
    with pytest.raises(UserError, match=message):
        fitted(0.04)
    assert fit_to(PRESET, least, horizon=HORIZON, speed=lambda _: 1.0).seeds == (0,)


def side_by_side(seconds: float):
    """On a machine where three processes step as fast as three times one."""
    return fit_to(PRESET, seconds, horizon=HORIZON, speed=float, workers=3)


def test_seeds_that_share_a_machine_are_waited_for_in_turns():
    """Four seeds on three processes take as long as six."""
    each = work(replace(PRESET, seeds=(0,)))
    assert side_by_side(FIXED_SECONDS + 2 * each) == PRESET
    assert side_by_side(FIXED_SECONDS + 2 * each - 1).iterations == 99
    least = work(replace(PRESET, seeds=(0,), iterations=20))
    assert side_by_side(FIXED_SECONDS + least).seeds == (0, 1, 2)


def test_time_for_fewer_seeds_than_processes_is_time_of_one_process():
    """Who has as little as one seed takes on all cores is not sent away."""

    def speed(workers):
        return 1.0 if workers == 1 else 1e-9

    least = FIXED_SECONDS + work(replace(PRESET, seeds=(0,), iterations=20))
    fit = fit_to(PRESET, least, horizon=HORIZON, speed=speed, workers=3)
    assert fit == replace(PRESET, seeds=(0,), iterations=20)


def test_no_time_at_all_is_refused():
    with pytest.raises(UserError, match="too short"):
        fit_to(PRESET, 1.0, horizon=HORIZON, speed=lambda _: 1e9)


def test_a_run_that_was_begun_keeps_its_budget(tmp_path, single_run):
    other = replace(TINY, iterations=999, per_round=(6,))
    assert stored_preset(single_run.directory, other) == replace(TINY, seeds=(0,))
    assert stored_preset(tmp_path, other) is None


@pytest.mark.parametrize("text", ["{", "[]", '{"identity": {"preset": {"per_round": 6}}}'])
def test_damaged_settings_hold_no_budget(tmp_path, text):
    (tmp_path / "settings.json").write_text(text)
    assert stored_preset(tmp_path, TINY) is None


def test_a_preset_survives_its_way_through_settings(tmp_path):
    stored = {"identity": {"preset": PRESET.describe()}, "seeds": [0, 1, 2, 3]}
    (tmp_path / "settings.json").write_text(json.dumps(stored))
    assert stored_preset(tmp_path, TINY) == PRESET


def test_speed_is_measured_by_stepping_the_task():
    assert training_speed(ToyReach()) > 0
