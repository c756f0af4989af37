"""The range of adversarialness as `rigid calibrate` measures it."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from rigid.compute.calibration import (
    _recorded_returns,
    calibrate,
    range_of_returns,
    rounded_range,
    spread_of,
)
from rigid.compute.return_range import find_return_range
from rigid.compute.subject import Subject
from rigid.data.episodes import save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.presets import PRESETS
from rigid.tasks.analytic.hand_tracking import HandTracking
from tests.compute.tiny import TINY, Notes, hasten_referees
from tests.toys import Follower, Pointer, ToyReach

EASY = replace(TINY, iterations=60, episodes=20, scoring_episodes=30)
"""Enough for λ = 0 to find the way out."""


class Unranged(HandTracking):
    """Hand tracking without a range, so that there is something to calibrate."""

    return_range = None


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory):
    """The file of a calibration, and what the listener heard."""
    place, notes = tmp_path_factory.mktemp("calibration"), Notes()
    with pytest.MonkeyPatch.context() as patch:
        hasten_referees(patch)
        calibrate(
            Subject(Unranged(), "builtin:tracker"), EASY,
            out=place / "range.json", run=place / "range.run", listener=notes,
        )  # fmt: skip
    return place / "range.json", notes


def test_the_ends_are_canonical_play_and_sabotage(calibrated):
    found = json.loads(calibrated[0].read_text())
    sabotage, canonical = found["returns"]["sabotage"], found["returns"]["canonical"]
    assert canonical["mean"] == pytest.approx(-0.26, abs=0.05)  # Exactly -0.2623.
    assert sabotage["mean"] < 1.5 * canonical["mean"]
    assert (found["worst"], found["best"]) == rounded_range(sabotage["mean"], canonical["mean"])
    assert canonical["quantiles"]["0.05"] < canonical["quantiles"]["0.95"]


def test_the_file_says_how_it_was_made(calibrated):
    found = json.loads(calibrated[0].read_text())
    assert found["task"] == dict(Unranged().describe())
    assert found["robot"]["name"] == "builtin:tracker"
    assert len(found["robot"]["sha256"]) == len(found["human"]["sha256"]) == 64
    assert found["budget"]["iterations"] == 60
    assert set(found["sabotage_by_seed"]) == {"0", "1"}
    assert {"rigid", "versions", "command"} <= set(found["provenance"])


def test_a_measurement_takes_the_file(calibrated):
    found = find_return_range(calibrated[0], Unranged())
    assert found.source == "calibrated"
    assert found.worst < found.best == 0.0


def test_a_calibration_that_was_done_is_not_trained_again(calibrated, tmp_path):
    place, notes = calibrated[0].parent, Notes()
    again = calibrate(
        Subject(Unranged(), "builtin:tracker"), EASY,
        out=tmp_path / "again.json", run=place / "range.run", listener=notes,
    )  # fmt: skip
    assert notes.done == 0
    assert again["worst"] == json.loads(calibrated[0].read_text())["worst"]


def test_sabotage_that_does_not_lower_the_return_is_refused_with_both_means():
    rng = np.random.default_rng(0)
    alike = [rng.normal(5, 1, 50), rng.normal(5, 1, 50)]
    with pytest.raises(UserError) as error:
        range_of_returns(alike, rng.normal(5, 1, 100))
    assert "λ = 0 earns 5" in str(error.value) or "λ = 0 earns 4.9" in str(error.value)
    assert "sabotage does not lower the return beyond noise" in str(error.value)
    assert "the human cannot influence the reward" in str(error.value)


@pytest.mark.parametrize("factor", [1e-6, 1.0, 1e6])
def test_rounding_depends_on_no_unit(factor):
    assert np.allclose(
        rounded_range(-271.7 * factor, 453.9 * factor), [-270 * factor, 450 * factor]
    )


def test_the_rule_of_rounding_gives_the_range_that_itch_scratching_has_frozen():
    from rigid.tasks.itch_scratching.task import RETURN_RANGE

    assert rounded_range(np.mean([-91, -356, -368]), 454.0) == RETURN_RANGE


def test_a_return_that_nobody_knows_proves_no_sabotage():
    with pytest.raises(UserError, match="sabotage does not lower the return beyond noise"):
        range_of_returns([np.zeros(5)], np.array([1.0, np.nan]))


@pytest.mark.parametrize(("known", "found"), [(3, [0.0, 1.0, 2.0]), (1, None)])
def test_only_known_returns_of_people_count_and_one_is_none(known, found, tmp_path):
    task = ToyReach()
    told = np.where(np.arange(12) < known, np.arange(12), np.nan).astype(np.float32)
    people = record(task, Follower(), Pointer(), episodes=12, seed=0, provenance={})
    save_episodes(tmp_path / "people.npz", replace(people, source="recorded", returns=told))
    subject = Subject(task, "builtin:none", canonical=str(tmp_path / "people.npz"))
    returns = _recorded_returns(subject)
    assert (None if returns is None else returns.tolist()) == found


def test_a_single_episode_has_no_standard_error():
    assert spread_of([np.array([1.0])])["se"] is None


def test_the_budget_by_default_is_the_papers():
    from rigid.commands.calibrating import CalibrateCommand

    assert CalibrateCommand.preset == "paper"
    assert PRESETS["paper"].iterations == 120
