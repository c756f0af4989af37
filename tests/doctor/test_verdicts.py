"""The verdicts on a new domain: which numbers pass, and what is said of those that do not."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.doctor.data import check_data
from rigid.doctor.ends import End, check_ends
from rigid.doctor.features import check_features
from rigid.doctor.noise import deviations_below
from rigid.doctor.reward import Play, check_reward
from rigid.doctor.scan import check_scan
from rigid.doctor.verdict import listed

RNG = np.random.default_rng(0)
NAMES = ("angle", "speed", "goal")
MOVING = RNG.normal(size=(10, 20, 3))


def changed(column, values):
    features = MOVING.copy()
    features[..., column] = values
    return features


def test_features_that_vary_pass():
    found = check_features(NAMES, MOVING, {"random": 3 * MOVING})
    assert found.status == "pass"
    assert found.evidence["spread"]["random"][0]["high"] > 2


@pytest.mark.parametrize("value", [0.0, 1e7, -0.3])
def test_a_constant_feature_fails_by_name(value):
    found = check_features(NAMES, changed(1, value), {})
    assert found.status == "fail"
    assert "1 of 3 key features is constant in canonical play: speed." in found.says
    assert "--features" in found.advice


def test_a_feature_that_is_not_finite_fails_by_name():
    found = check_features(NAMES, changed(2, np.nan), {})
    assert found.status == "fail"
    assert found.says == "Not every value is a finite number: goal."


def played(canonical, passive, random, sabotage=(), **options):
    rows = {"canonical": canonical, "passive": passive, "random": random}
    rewards = {kind: np.asarray(rewards, dtype=float) for kind, rewards in rows.items()}
    return Play(rewards, [np.asarray(group, dtype=float) for group in sabotage], **options)


NOISE = RNG.normal(size=(3, 60, 10))
GOOD, BAD = NOISE[0] + 1, NOISE[1] - 1


def test_equal_rewards_from_equal_starts_mean_that_the_human_has_no_influence():
    found = check_reward(played(GOOD, GOOD, GOOD))
    assert found.status == "fail"
    assert found.says.startswith("The human has no influence on the reward: passive and random")


def test_sabotage_that_earns_less_passes():
    found = check_reward(played(GOOD, GOOD + 0.01, GOOD - 0.01, [(BAD - 3).sum(axis=1)]))
    assert (found.status, found.evidence["rewarded_steps"]) == ("pass", 1.0)
    assert "λ = 0 lowers the return from " in found.says


def test_reward_that_only_chance_moves_fails():
    found = check_reward(played(GOOD, NOISE[1] + 1, NOISE[2] + 1, [(NOISE[1] + 1).sum(axis=1)]))
    assert found.status == "fail"
    assert "no human that was tried lowers the return beyond noise" in found.says


def test_an_adversary_that_learned_nothing_is_told_from_a_human_without_influence():
    play = played(GOOD, BAD, NOISE[2] + 1, [(NOISE[2] + 1).sum(axis=1)], iterations=40)
    found = check_reward(play)
    assert found.status == "fail"
    assert "trained for 40 iterations" in found.says
    assert "learned nothing, though a passive human earns less" in found.says


def test_an_adversary_below_whom_an_untrained_human_stands_is_a_warning():
    found = check_reward(played(GOOD, BAD - 9, GOOD, [BAD.sum(axis=1)]))
    assert found.status == "warn"
    assert "a passive human, whom nobody trained, does more harm" in found.says


def test_a_sparse_reward_is_a_warning():
    sparse = np.zeros((60, 100))
    sparse[:, -1] = RNG.normal(5, 1, 60)
    found = check_reward(played(sparse, sparse + 0, sparse * 1.01, [np.zeros(60)]))
    assert found.status == "warn"
    assert "only 1.0% of the steps have any reward" in found.says


def test_without_adversaries_the_reward_is_not_judged():
    assert check_reward(played(GOOD, BAD, BAD)).status == "skip"


CURVE = {3: [0.7], 6: [0.85], 12: [0.9], 25: [0.94], 50: [0.95], 100: [0.95]}


@pytest.mark.parametrize(
    ("episodes", "status"), [(3, "fail"), (11, "fail"), (13, "warn"), (40, "pass"), (500, "pass")]
)
def test_the_verdict_on_data_follows_the_learning_curve(episodes, status):
    assert check_data(episodes, CURVE, source="synthetic").status == status


def test_too_few_episodes_are_told_how_many_would_do():
    found = check_data(3, CURVE, source="synthetic")
    assert found.says == (
        "With 3 canonical episodes a judge tells 70% of held-out steps right, with 100 it tells "
        "95%: too few."
    )
    assert found.advice == "Record more with `rigid record --episodes N`: about 25 would be enough."
    assert found.evidence["enough"] == 25


def test_fewer_than_the_referee_takes_fail_however_flat_the_curve():
    flat = {size: [0.9] for size in CURVE}
    found = check_data(3, flat, source="recorded")
    assert (found.status, found.advice) == ("fail", "Record more: about 12 would be enough.")


def test_a_curve_that_still_rises_at_its_end_is_a_warning():
    found = check_data(50, {12: [0.8], 25: [0.85], 50: [0.9]}, source="recorded")
    assert found.status == "warn"
    assert "still rises there" in found.says
    assert found.advice == "Record more: about 100 may be enough."


def test_of_recorded_people_the_curve_is_read_where_referees_are_trained_and_both_are_told():
    found = check_data(60, CURVE, source="recorded", trained=12)
    assert found.status == "warn"
    assert found.says.startswith(
        "With 60 canonical episodes, 12 of which train each referee, a judge tells 90% of held-out "
        "steps right, with 100 to train on it tells 95%"
    )
    assert found.evidence["enough"] == 125  # 25 to train on.
    assert check_data(60, CURVE, source="synthetic").status == "pass"


def test_a_curve_at_chance_says_nothing_and_is_a_warning():
    found = check_data(100, {size: [0.52] for size in CURVE}, source="synthetic")
    assert found.status == "warn"
    assert "hardly more than chance" in found.says


def test_without_a_curve_there_is_too_little_to_judge():
    found = check_data(4, {}, source="recorded")
    assert found.status == "fail"
    assert "at least 12, better 40" in found.advice


CANONICAL = End([RNG.normal(10, 1, 60)], 0.9)
BROKEN = End([RNG.normal(-10, 1, 60)], 0.1, [0.0, 0.1])
STILL = End([RNG.normal(10, 1, 60)], 0.9, [0.8, 0.9])


def test_ends_as_they_should_be_pass():
    found = check_ends(CANONICAL, BROKEN, STILL)
    assert found.status == "pass"
    assert "success 0.10 instead of 0.90" in found.says


def test_a_pair_that_hardly_helps_is_a_warning():
    found = check_ends(End(CANONICAL.returns, 0.02), End(BROKEN.returns, 0.0, [0.0]), STILL)
    assert found.status == "warn"
    assert "canonical play itself succeeds only in 2% of the episodes" in found.says


def test_a_task_without_success_is_broken_where_returns_are_rare():
    ends = [end.__class__(end.returns, None, end.naturalness) for end in (CANONICAL, BROKEN, STILL)]
    found = check_ends(*ends)
    assert found.status == "pass"
    assert "canonical 5 %" in found.says


@pytest.mark.parametrize(
    ("sabotage", "natural", "status", "says"),
    [
        (CANONICAL, STILL, "fail", "λ = 0 does not break the task"),
        (BROKEN, End(STILL.returns, 0.9, [0.3]), "fail", "does not look canonical"),
        (BROKEN, End(STILL.returns, 0.9, [0.6]), "warn", "less than 0.7"),
        (End(BROKEN.returns, 0.8, [0.1]), STILL, "warn", "weakens the task (10.0"),
    ],
    ids=["robust", "unnatural", "hardly natural", "weakened"],
)
def test_each_end_is_judged(sabotage, natural, status, says):
    found = check_ends(CANONICAL, sabotage, natural)
    assert found.status == status
    assert says.split("(")[0] in found.says


LAMBDAS = (0.0, 0.1, 1.0, 10.0, float("inf"))


def scan(*means):
    naturalness = {value: [mean] for value, mean in zip(LAMBDAS, means, strict=True)}
    return check_scan(naturalness, {value: 1 - mean for value, (mean,) in naturalness.items()})


def test_a_gradual_curve_passes():
    found = scan(0.0, 0.3, 0.5, 0.8, 0.9)
    assert found.status == "pass"
    assert "3 of 5 λ lie between the ends" in found.says


def test_a_jump_is_a_warning_that_says_where():
    found = scan(0.0, 0.02, 0.9, 0.85, 0.95)
    assert found.status == "warn"
    assert "between λ = 0.1 and λ = 1." in found.says


def test_no_rise_is_no_curve():
    assert "there is no curve yet" in scan(0.5, 0.5, 0.55, 0.5, 0.6).says


def test_rounding_is_no_difference_and_any_other_is_where_nothing_varies():
    assert deviations_below([np.full(5, 1 + 1e-9)], np.full(5, 1.0)) == 0.0
    assert deviations_below([np.full(5, 2.0)], np.full(5, 1.0)) == -np.inf


def test_long_lists_of_names_are_cut():
    assert listed([str(number) for number in range(5)]) == "0, 1, 2, 3, 4"
