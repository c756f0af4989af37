"""What discriminators tell apart, where it is known: linear judges of Gaussian motion."""

from __future__ import annotations

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import norm

from rigid.compute.referee.files import save_panel
from rigid.compute.run.checkpoint import save_arrays, save_tree
from rigid.compute.search.discriminator_files import load_discriminators
from rigid.compute.search.discriminators import POSE_LEVELS, POSES, write_discriminators
from rigid.compute.search.group_plan import GroupInputs
from rigid.compute.search.scoring import Ruler
from rigid.errors import UserError
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.group_play import Opponent, canonical_motion
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.noise import NOISE_LEVELS
from rigid.naturalness.panel import Fold, Jury
from rigid.naturalness.referee import Referee, RefereeSettings
from rigid.naturalness.standardise import Scale, canonical_scale, standardise
from tests.compute.tiny import TINY
from tests.toys import Follower, ToyReach, untrained

STEPS = 400
CUT = 1.0
"""The discriminator takes for canonical what lies below this, in canonical deviations."""
SHIFTS = {"s3-r1-l1": 0.0, "s3-r1-l2": 2.0, "s3-r2-l1": 1.0}
"""How far the mean of each human lies from canonical motion."""
LINEAR = AdversarySettings(discriminator=DiscriminatorSettings(hidden=()))
SAMPLING = 0.015
"""Three deviations of a share of some 10,000 steps."""


def motion(seed, *, shift=0.0, episodes=20):
    """A hand of law N(shift, 1) and a goal of ±1, which are independent."""
    rng = np.random.default_rng(seed)
    hand = rng.normal(shift, 1, (episodes, STEPS))
    return np.stack([hand, rng.choice([-1.0, 1.0], hand.shape)], axis=-1).astype(np.float32)


def linear(weight, bias):
    return [{"w": jnp.array([[weight], [0.0]]), "b": jnp.array([bias])}]


def store(directory, human, shift, *, sound=None):
    """A human as its group leaves it: referees that are twice as lenient as the discriminator."""
    place = directory / "adversaries" / human
    save_tree(place / "discriminator.safetensors", linear(1.0, -CUT))
    features = motion(1 + int(10 * shift), shift=shift)
    sound = np.ones(features.shape[:2], dtype=bool) if sound is None else sound
    save_arrays(place / "episodes.npz", {"features": features, "sound": sound})
    plain = Scale(np.zeros(2, np.float32), np.eye(2, dtype=np.float32))
    referee = Referee(linear(1.0, np.log(4.0) - 2 * CUT), plain)
    panel = {"step": Jury((referee, referee), {})}
    save_panel(directory / "referee", human, panel, ToyReach.feature_names)


@pytest.fixture
def inputs(tmp_path):
    task = ToyReach()
    for human, shift in SHIFTS.items():
        store(tmp_path, human, shift)
    folds = tuple(Fold(*(motion(10 * fold + use) for use in range(3))) for fold in (1, 2))
    human = untrained(task.human).parameters
    opponent = Opponent(Follower(), human, motion(0, episodes=40), np.arange(40), 1.0)
    ruler = Ruler(folds, task.return_range, RefereeSettings())
    return GroupInputs(task, opponent, ruler, TINY, LINEAR, tmp_path)


def examined(inputs, seed=3, humans=tuple(SHIFTS)):
    write_discriminators(inputs, seed, humans)
    return load_discriminators(inputs.directory, seed)


@pytest.mark.parametrize(("judge", "cut"), [("discriminator", CUT), ("referee", 2 * CUT)])
def test_accuracy_under_noise_is_the_closed_form(inputs, judge, cut):
    """Noise of level n makes a deviation of 1 one of √(1 + n²)."""
    found = getattr(examined(inputs).judged["s3-r1-l1"], judge).canonical
    expected = norm.cdf(cut / np.sqrt(1 + np.square(NOISE_LEVELS)))
    np.testing.assert_allclose(found, expected, atol=SAMPLING)


@pytest.mark.parametrize(("judge", "cut"), [("discriminator", CUT), ("referee", 2 * CUT)])
def test_every_human_of_the_seed_is_judged_by_every_other(inputs, judge, cut):
    for judged in examined(inputs).judged.values():
        found = getattr(judged, judge).adversaries
        assert set(found) == set(SHIFTS)
        for human, shift in SHIFTS.items():
            assert found[human] == pytest.approx(norm.sf(cut - shift), abs=SAMPLING)


def test_verdicts_are_those_of_the_poses_that_are_shown(inputs):
    """The second feature weighs nothing, and canonical motion is its own unit."""
    seen = examined(inputs)
    noisy = np.array(seen.poses.noisy)
    assert noisy.shape == (len(POSE_LEVELS), POSES, 2)
    for human, judged in seen.judged.items():
        np.testing.assert_allclose(judged.scores.noisy, noisy[..., 0] - CUT, rtol=0.05, atol=0.06)
        own = np.array(seen.poses.own[human])
        np.testing.assert_allclose(judged.scores.own, own[:, 0] - CUT, rtol=0.05, atol=0.06)


def test_what_follows_a_fault_is_neither_counted_nor_shown(inputs):
    sound = np.arange(STEPS) < np.full((20, 1), STEPS // 2)
    features = motion(1)
    features[~sound] = 100.0
    place = inputs.directory / "adversaries" / "s3-r1-l1" / "episodes.npz"
    save_arrays(place, {"features": features, "sound": sound})
    seen = examined(inputs)
    share = seen.judged["s3-r1-l2"].discriminator.adversaries["s3-r1-l1"]
    assert share == pytest.approx(norm.sf(CUT), abs=2 * SAMPLING)
    assert np.abs(np.array(seen.poses.own["s3-r1-l1"])).max() < 10


def test_the_same_seed_gives_the_same_file_and_another_seed_other_noise(inputs):
    place = inputs.directory / "discriminators"
    texts = []
    for seed in (3, 3, 4):
        (place / f"s{seed}.json").unlink(missing_ok=True)
        examined(inputs, seed)
        texts.append((place / f"s{seed}.json").read_bytes())
    assert texts[0] == texts[1] != texts[2]


def test_what_was_examined_once_is_left_alone(inputs):
    place = inputs.directory / "discriminators" / "s3.json"
    place.parent.mkdir()
    place.write_text("of an earlier session")
    write_discriminators(inputs, 3, list(SHIFTS))
    assert place.read_text() == "of an earlier session"


def untrained_measure(inputs, name):
    """The inputs of a run with another measure, and its state before training."""
    settings = AdversarySettings(measure=name, discriminator=DiscriminatorSettings(hidden=(8, 8)))
    measure = settings.search_measure
    canonical = canonical_motion(inputs.opponent)
    state = measure.start(jax.random.key(0), canonical, inputs.opponent.human)
    for human in SHIFTS:
        place = inputs.directory / "adversaries" / human / "discriminator.safetensors"
        save_tree(place, measure.kept(state))
    return replace(inputs, settings=settings), state


@pytest.mark.parametrize("measure", ["kl", "mmd"])
def test_a_measure_without_a_discriminator_has_none(inputs, measure):
    assert examined(untrained_measure(inputs, measure)[0]).judged is None


@pytest.mark.parametrize("measure", ["kl-gan", "temporal", "ensemble"])
def test_a_verdict_on_a_pose_takes_in_what_went_before(inputs, measure):
    inputs, state = untrained_measure(inputs, measure)
    human = "s3-r1-l1"
    seen, features = examined(inputs, humans=[human]), motion(1)
    scale = canonical_scale(inputs.opponent.canonical)
    rows = jnp.asarray(standardise(scale, features).swapaxes(0, 1))
    scores = np.asarray(inputs.settings.search_measure.score(state, rows)).T
    for step, score in zip(seen.poses.own[human], seen.judged[human].scores.own, strict=True):
        place = np.abs(features - np.array(step)).sum(axis=-1).argmin()
        assert score == pytest.approx(scores.ravel()[place], abs=1e-4)


def test_motion_that_an_earlier_version_did_not_store_is_unknown(inputs):
    place = inputs.directory / "adversaries" / "s3-r1-l2" / "episodes.npz"
    save_arrays(place, {"returns": np.zeros(3)})
    seen = examined(inputs)
    assert seen.judged["s3-r1-l1"].discriminator.adversaries["s3-r1-l2"] is None
    assert seen.judged["s3-r1-l2"].scores.own == seen.poses.own["s3-r1-l2"] == ()


def test_a_human_without_referees_still_has_a_discriminator(inputs):
    save_panel(inputs.directory / "referee", "s3-r1-l1", {}, ToyReach.feature_names)
    judged = examined(inputs).judged["s3-r1-l1"]
    assert judged.referee is None
    assert len(judged.discriminator.canonical) == len(NOISE_LEVELS)


@pytest.mark.parametrize("file", ["discriminator.safetensors", "episodes.npz"])
def test_a_damaged_file_names_its_cure(inputs, file):
    place = inputs.directory / "adversaries" / "s3-r2-l1" / file
    place.write_bytes(place.read_bytes()[:40])
    cure = rf"s3-r2-l1/{file} .*: delete groups/s3-r2\.json to train its group again"
    with pytest.raises(UserError, match=cure):
        examined(inputs)


def test_its_own_human_is_told_as_often_as_the_point_says(small_run):
    """With so few scored episodes all of them are stored."""
    for point in small_run.points:
        seen = load_discriminators(small_run.directory, point["seed"])
        told = seen.judged[point["id"]].discriminator.adversaries[point["id"]]
        assert told == pytest.approx(1 - point["naturalness_own"], abs=1e-9)


def test_humans_of_every_round_are_judged(small_run):
    for seed in (0, 1):
        ids = {point["id"] for point in small_run.points if point["seed"] == seed}
        seen = load_discriminators(small_run.directory, seed)
        assert set(seen.judged) == ids
        assert {frozenset(judged.referee.adversaries) for judged in seen.judged.values()} == {
            frozenset(ids)
        }
