"""Canonical episodes survive the disk, and every bad file is refused with place and cure."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.data.episodes import CanonicalEpisodes, data_hash, load_episodes, save_episodes
from rigid.errors import UserError
from tests.toys import ToyReach

TASK = ToyReach()
ARRAYS = ("features", "observations", "actions", "seeds", "returns", "success")


def some_episodes(count=3, task=TASK, **changes):
    rng = np.random.default_rng(0)

    def noise(*shape):
        return rng.standard_normal(shape).astype(np.float32)

    fields = {
        "features": noise(count, task.horizon, 2),
        "observations": noise(count, task.horizon, 3),
        "actions": noise(count, task.horizon, 1),
        "seeds": np.arange(count),
        "returns": noise(count),
        "success": np.ones(count, np.float32),
        "task": task.describe(),
        "feature_names": task.feature_names,
        "source": "synthetic",
        "provenance": {"robot": "abc"},
    }
    return CanonicalEpisodes(**fields | changes)


@pytest.fixture
def path(tmp_path):
    save_episodes(tmp_path / "canonical.npz", some_episodes())
    return tmp_path / "canonical.npz"


def edit(path, header=None, **arrays):
    """Rewrites a file; None drops an array."""
    with np.load(path, allow_pickle=False) as file:
        found = dict(file)
    changed = json.loads(str(found["header"])) | (header or {})
    found |= {"header": np.array(json.dumps(changed)), **arrays}
    np.savez(path, **{name: array for name, array in found.items() if array is not None})


def refused(path, message, task=TASK):
    with pytest.raises(UserError, match=message) as caught:
        load_episodes(path, task=task)
    assert str(caught.value).startswith(str(path))


def test_what_was_saved_is_loaded(path):
    loaded, saved = load_episodes(path, task=TASK), some_episodes()
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(loaded, name), getattr(saved, name))
        assert getattr(loaded, name).dtype == getattr(saved, name).dtype
    assert len(loaded) == 3
    assert (loaded.task, loaded.provenance) == (saved.task, saved.provenance)
    assert (loaded.feature_names, loaded.source) == (saved.feature_names, saved.source)
    assert loaded.control_period == 0.1


def test_recorded_people_need_neither_observations_nor_actions(path):
    people = some_episodes(observations=None, actions=None, source="recorded", control_period=0.05)
    save_episodes(path, people)
    loaded = load_episodes(path, task=TASK)
    assert (loaded.observations, loaded.actions) == (None, None)
    assert (loaded.source, loaded.control_period) == ("recorded", 0.05)


def test_returns_and_success_may_be_unknown(path):
    unknown = np.full(3, np.nan, np.float32)
    save_episodes(path, some_episodes(returns=unknown, success=unknown))
    assert np.isnan(load_episodes(path, task=TASK).success).all()


def test_equal_episodes_give_equal_bytes(path, tmp_path):
    save_episodes(tmp_path / "new" / "again.npz", load_episodes(path, task=TASK))
    assert (tmp_path / "new" / "again.npz").read_bytes() == path.read_bytes()


def test_forty_episodes_of_itch_scratching_size_are_small(tmp_path):
    # Noise does not compress: real motion does better.
    noise = np.random.default_rng(0).standard_normal((40, 100, 22)).astype(np.float32)
    names = tuple(f"f{index}" for index in range(22))
    large = some_episodes(
        40, ToyReach(horizon=100), features=noise, feature_names=names, observations=None
    )
    save_episodes(tmp_path / "large.npz", large)
    assert (tmp_path / "large.npz").stat().st_size < 400_000


def test_the_hash_ignores_provenance_and_a_trip_to_the_disk(path):
    loaded = load_episodes(path, task=TASK)
    assert data_hash(loaded) == data_hash(some_episodes(provenance={}))


@pytest.mark.parametrize("name", [*ARRAYS, "task", "feature_names", "source", "control_period"])
def test_the_hash_changes_with_everything_else(name):
    old = some_episodes()
    changes = {
        "task": {"name": "another"},
        "feature_names": ("goal", "hand"),
        "source": "recorded",
        "control_period": 0.05,
    }
    value = changes[name] if name in changes else getattr(old, name) + 1
    assert data_hash(replace(old, **{name: value})) != data_hash(old)


def test_the_hash_tells_absent_from_empty_handed():
    assert data_hash(some_episodes(actions=None)) != data_hash(some_episodes())


def test_another_tasks_file_is_refused_with_both_names(path):
    message = "holds episodes of task 'toy-reach', not 'toy-other': record some with `rigid record"
    refused(path, message, ToyReach(name="toy-other"))


def test_a_file_of_other_parameters_is_refused_with_both_values(path):
    message = r"recorded with parameters\.horizon = 10, but task 'toy-reach' has 12: record it"
    refused(path, message, ToyReach(horizon=12))


def test_a_file_from_before_a_parameter_was_added_is_taken(path):
    edit(path, {"task": {"name": "toy-reach", "version": 0, "parameters": {}}})
    assert len(load_episodes(path, task=TASK)) == 3


def test_without_a_task_any_tasks_file_is_taken(path):
    edit(path, {"task": {"name": "another"}, "feature_names": ["x", "y"]})
    assert load_episodes(path, task=None).feature_names == ("x", "y")


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["hand"], r"has 1 features, but task 'toy-reach' has 2 \(hand, goal\)"),
        (["hand", "aim"], "calls feature 1 'aim', but task 'toy-reach' calls it 'goal'"),
        (["goal", "hand"], "calls feature 0 'goal', but task 'toy-reach' calls it 'hand'"),
    ],
    ids=["fewer", "other", "other-order"],
)
def test_wrong_feature_names_are_refused(path, names, message):
    edit(path, {"feature_names": names})
    refused(path, message)


@pytest.mark.parametrize(
    ("name", "value", "where"),
    [
        ("features", np.nan, r"features hold 1 numbers .* episode 2, step 4, feature 'goal'"),
        ("features", np.inf, r"features hold 1 numbers .* episode 2, step 4, feature 'goal'"),
        ("observations", np.nan, r"observations hold 1 .* step 4, observation 'hand'"),
    ],
)
def test_a_number_that_is_not_finite_is_found(path, name, value, where):
    array = getattr(some_episodes(), name)
    array[2, 4, 1] = value
    edit(path, **{name: array})
    refused(path, where + ": leave such episodes out")


@pytest.mark.parametrize("name", ["returns", "success"])
def test_what_is_unknown_of_an_episode_is_nan_and_never_infinite(path, name):
    values = getattr(some_episodes(), name)
    values[:2] = np.nan, np.inf
    edit(path, **{name: values})
    refused(path, f"{name} are infinite, first in episode 1: give NaN where unknown")


def test_success_is_0_or_1_or_unknown(path):
    edit(path, success=np.array([1.0, np.nan, 0.5]))
    refused(path, "success of episode 2 is 0.5, but must be 1 or 0")


def test_a_seed_below_0_is_refused(path):
    edit(path, seeds=np.array([0, -1, 2]))
    refused(path, "the seed of episode 1 is -1, but must be 0 or more")


def test_a_number_too_large_for_float32_is_not_finite(path):
    features = some_episodes().features.astype(np.float64)
    features[0, 0, 0] = 1e300
    edit(path, features=features)
    refused(path, "features hold 1 numbers that are not finite, the first in episode 0, step 0")


@pytest.mark.parametrize(
    ("name", "shape", "message"),
    [
        ("features", (0, 10, 2), r"features have shape \(0, 10, 2\)"),
        ("features", (3, 10), r"features have shape \(3, 10\), not \(episodes, steps, features\)"),
        ("features", (3, 10, 3), "names 2 features, but holds 3: give each feature its name"),
        ("observations", (3, 9, 3), r"observations have shape \(3, 9, 3\), but .* of 10 steps"),
        ("observations", (3, 10, 4), "holds 4 observations a step, but the human .* has 3"),
        ("actions", (2, 10, 1), r"actions have shape \(2, 10, 1\), but .* for 3 episodes"),
        ("actions", (3, 10, 2), "holds 2 actions a step, but the human .* has 1"),
        ("returns", (2,), r"returns have shape \(2,\), but there are features for 3 episodes"),
        ("success", (3, 1), r"success have shape \(3, 1\)"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(path, name, shape, message):
    edit(path, **{name: np.zeros(shape, np.float32)})
    refused(path, message)


def test_short_episodes_are_refused(path):
    whole = some_episodes()
    cut = {name: getattr(whole, name)[:, :6] for name in ("features", "observations", "actions")}
    edit(path, **cut)
    refused(path, "episodes of 6 steps, but those of 'toy-reach' have 10: record whole episodes")


def test_ragged_episodes_are_refused(path):
    ragged = np.array([np.zeros((10, 2)), np.zeros((9, 2))], dtype=object)
    edit(path, features=ragged)
    refused(path, "Object arrays cannot be loaded .*: give every episode the same number of steps")


@pytest.mark.parametrize("name", ["features", "seeds", "returns", "success"])
def test_a_missing_array_is_named(path, name):
    edit(path, **{name: None})
    refused(path, f"has no '{name}': copy the file or record it again")


@pytest.mark.parametrize(
    ("name", "array", "kind"),
    [("features", np.full((3, 10, 2), "x"), "<U1"), ("seeds", np.zeros(3), "float64")],
)
def test_an_array_of_another_kind_is_refused(path, name, array, kind):
    edit(path, **{name: array})
    refused(path, f"{name} are {kind}")


def test_a_newer_format_is_refused(path):
    edit(path, {"format": 2})
    refused(path, "has format version 2, but this RIGID reads up to 1: install a newer")


def test_a_bad_header_is_refused_with_its_entry(path):
    edit(path, {"source": "invented"})
    refused(path, "source: Input should be 'synthetic' or 'recorded'")


def test_somebody_elses_npz_is_refused(tmp_path):
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    refused(tmp_path / "other.npz", "has no header: record canonical episodes")


@pytest.mark.parametrize("data", [b"", b"PK", b"episode,step\n0,0\n", b"\x93NUMPY\x01\x00"])
def test_a_file_that_is_no_npz_is_refused(tmp_path, data):
    (tmp_path / "file.npz").write_bytes(data)
    refused(tmp_path / "file.npz", "is no .npz file: record one with `rigid record`")


def test_a_missing_file_is_refused(tmp_path):
    refused(tmp_path / "absent.npz", "does not exist: record it with `rigid record`")


def test_a_folder_is_refused(tmp_path):
    refused(tmp_path, r"cannot be read .*Is a directory")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "canonical.npz"
    save_episodes(path, some_episodes())
    return path, path.read_bytes()


@given(share=st.floats(0.0, 1.0, exclude_max=True))
def test_every_truncated_file_is_refused(whole, share):
    path, data = whole
    cut = path.with_name("cut.npz")
    cut.write_bytes(data[: int(share * len(data))])
    with pytest.raises(UserError, match=r"copy the file or record it|is no \.npz file"):
        load_episodes(cut, task=TASK)


@given(data=st.data())
def test_a_damaged_byte_never_escapes_as_another_error(whole, data):
    path, sound = whole
    at = data.draw(st.integers(0, len(sound) - 1))
    byte = data.draw(st.integers(0, 255))
    damaged = path.with_name("damaged.npz")
    damaged.write_bytes(sound[:at] + bytes([byte]) + sound[at + 1 :])
    try:
        loaded = load_episodes(damaged, task=TASK)
    except UserError:
        return
    assert data_hash(loaded) == data_hash(some_episodes())


@pytest.mark.parametrize(("offset", "value"), [(8, 0x01), (10, 0x63)], ids=["flags", "compression"])
def test_an_archive_that_claims_to_be_encrypted_or_packed_otherwise_is_refused(path, offset, value):
    data = bytearray(path.read_bytes())
    data[data.index(b"PK\x01\x02") + offset] = value  # First entry of the zip's directory.
    path.write_bytes(data)
    refused(path, "is truncated or cannot be read .*: copy the file or record it again")


def test_nothing_is_saved_that_could_not_be_loaded(tmp_path):
    broken = some_episodes()
    broken.features[1, 2, 0] = np.nan
    with pytest.raises(UserError, match="episode 1, step 2, feature 'hand'"):
        save_episodes(tmp_path / "new.npz", broken)
    assert not list(tmp_path.iterdir())
