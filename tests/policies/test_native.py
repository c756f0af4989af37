"""A stored policy acts as it did in memory, or is refused with the reason."""

from __future__ import annotations

import json

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from rigid.errors import UserError
from rigid.policies.architecture import architecture_of, weights_of
from rigid.policies.native import (
    CARD_FILE,
    WEIGHTS_FILE,
    hash_weights,
    load_card,
    load_native,
    save_policy,
)
from tests.toys import ToyReach, untrained, untrained_palm

TASK = ToyReach()


def store(directory, policy=None, **provenance):
    policy = policy or untrained(TASK.human)
    return save_policy(
        policy, directory, agent="human", task=TASK.describe(), provenance=provenance
    )


def edit_card(directory, **changes):
    path = directory / CARD_FILE
    card = json.loads(path.read_text())
    card["architecture"] |= changes.pop("architecture", {})
    path.write_text(json.dumps(card | changes))


def edit_weights(directory, change):
    weights = load_file(directory / WEIGHTS_FILE)
    change(weights)
    save_file(weights, directory / WEIGHTS_FILE)


def act(policy, steps=5):
    """Actions with noise over a few steps, so that memory and spread count."""
    state, rng, observations = policy.initial_state(4), np.random.default_rng(0), []
    see = np.random.default_rng(1).standard_normal((steps, 4, policy.observation_size))
    for observation in see.astype(np.float32):
        action, state = policy.act(observation, state, rng)
        observations.append(action)
    return np.array(observations)


@pytest.mark.parametrize("memory", [1, 3])
@pytest.mark.parametrize("hidden", [(), (5,), (8, 4)], ids=len)
def test_a_loaded_policy_acts_as_the_saved_one(tmp_path, memory, hidden):
    policy = untrained(TASK.human, memory=memory, hidden=hidden)
    store(tmp_path / "new" / "folder", policy)
    loaded = load_native(tmp_path / "new" / "folder").policy
    np.testing.assert_array_equal(act(loaded), act(policy))


def test_a_loaded_palm_policy_acts_as_the_saved_one(tmp_path):
    policy = untrained_palm(TASK.human)
    store(tmp_path, policy)
    loaded, card = load_native(tmp_path)
    np.testing.assert_array_equal(act(loaded), act(policy))
    assert card.architecture.model_dump() == {
        "kind": "palm",
        "observation_size": 3,
        "action_size": 1,
        "memory": 4,
        "hidden": (8, 4),
        "encoder_hidden": 5,
        "latent": 2,
    }


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"memory": 101}, "memory: Input .* less than or equal to 100"),
        ({"latent": 3}, r"encoder\.mean\.b has shape \(2,\), but the architecture .* \(3,\)"),
        ({"kind": "gaussian"}, r"encoder\.change\.count is unknown to the architecture"),
    ],
)
def test_a_card_that_does_not_fit_a_palm_policy_is_refused(tmp_path, changes, message):
    store(tmp_path, untrained_palm(TASK.human))
    edit_card(tmp_path, architecture=changes)
    with pytest.raises(UserError, match=message):
        load_native(tmp_path)


def test_the_card_says_what_the_policy_is(tmp_path):
    store(tmp_path, untrained(TASK.human, memory=2), recipe="none", seed=3)
    card = load_native(tmp_path).card
    assert card.architecture.model_dump() == {
        "kind": "gaussian",
        "observation_size": 3,
        "action_size": 1,
        "memory": 2,
        "hidden": (8, 4),
    }
    assert (card.format, card.agent) == (1, "human")
    assert card.task == TASK.describe()
    assert card.provenance == {"recipe": "none", "seed": 3}


def test_the_running_moments_are_kept(tmp_path):
    policy = untrained(TASK.human)
    moments = policy.parameters.normaliser._replace(mean=np.array([1.0, 2.0, 3.0], np.float32))
    policy.parameters = policy.parameters._replace(normaliser=moments)
    store(tmp_path, policy)
    np.testing.assert_array_equal(
        load_native(tmp_path).policy.parameters.normaliser.mean, moments.mean
    )


def test_saving_again_replaces_the_policy_and_nothing_else(tmp_path):
    (tmp_path / "metrics.jsonl").write_text("{}")
    store(tmp_path, untrained(TASK.human, seed=0))
    store(tmp_path, untrained(TASK.human, seed=1))
    assert (load_native(tmp_path).card.sha256) == store(
        tmp_path / "b", untrained(TASK.human, seed=1)
    ).sha256
    names = {path.name for path in tmp_path.iterdir() if path.is_file()}
    assert names == {"metrics.jsonl", CARD_FILE, WEIGHTS_FILE}


def test_the_hash_ignores_where_a_policy_comes_from(tmp_path):
    assert store(tmp_path / "a", seed=1).sha256 == store(tmp_path / "b", seed=2).sha256


@pytest.mark.parametrize("policy", [untrained(TASK.human), untrained_palm(TASK.human)])
def test_the_hash_changes_with_any_weight(policy):
    architecture, weights = architecture_of(policy), weights_of(policy)
    hashes = {hash_weights(architecture, weights)}
    for name in weights:
        changed = weights | {name: weights[name] + np.float32(1e-3)}
        hashes.add(hash_weights(architecture, changed))
    assert len(hashes) == 1 + len(weights)


def test_weights_that_are_not_finite_are_not_written(tmp_path):
    policy = untrained(TASK.human)
    spread = np.array([np.nan], np.float32)
    policy.parameters = policy.parameters._replace(log_std=spread)
    with pytest.raises(ValueError, match="not finite in log_std"):
        store(tmp_path, policy)
    assert not list(tmp_path.iterdir())


def test_provenance_that_is_no_json_leaves_the_old_policy(tmp_path):
    old = store(tmp_path)
    with pytest.raises(ValueError, match="JSON compliant"):
        store(tmp_path, untrained(TASK.human, seed=1), loss=float("nan"))
    assert load_native(tmp_path).card == old


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (CARD_FILE, r"policy\.json does not exist: a native policy is a directory with"),
        (WEIGHTS_FILE, r"policy\.safetensors does not exist: copy the policy or train it again"),
    ],
)
def test_a_missing_file_is_named(tmp_path, name, message):
    store(tmp_path)
    (tmp_path / name).unlink()
    with pytest.raises(UserError, match=message):
        load_native(tmp_path)


@pytest.mark.parametrize("kept", [0.0, 0.01, 0.5, 0.99])
def test_truncated_weights_are_refused(tmp_path, kept):
    store(tmp_path)
    path = tmp_path / WEIGHTS_FILE
    data = path.read_bytes()
    path.write_bytes(data[: int(kept * len(data))])
    with pytest.raises(UserError, match=r"truncated or damaged .* copy the policy or train it"):
        load_native(tmp_path)


def test_a_truncated_card_is_refused(tmp_path):
    store(tmp_path)
    path = tmp_path / CARD_FILE
    path.write_text(path.read_text()[:-20])
    with pytest.raises(UserError, match=r"policy\.json: the header: Invalid JSON"):
        load_native(tmp_path)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        pytest.param({"format": 2}, "version 2, but this RIGID reads up to 1", id="newer"),
        pytest.param({"agent": "dog"}, "agent: Input should be 'robot' or 'human'", id="agent"),
        pytest.param(
            {"architecture": {"kind": "x"}},
            "architecture: Input tag 'x' .* expected tags: 'gaussian', 'palm'",
            id="kind",
        ),
        pytest.param(
            {"architecture": {"memory": 0}}, "memory: Input .* greater than 0", id="memory"
        ),
        pytest.param(
            {"architecture": {"hidden": [8, 5]}},
            r"network\.1\.b has shape \(4,\), but the architecture in policy\.json has \(5,\)",
            id="width",
        ),
        pytest.param(
            {"architecture": {"hidden": [8]}},
            r"network\.1\.b has shape \(4,\).* has \(1,\)",
            id="fewer-layers",
        ),
        pytest.param(
            {"architecture": {"hidden": [8, 4, 1]}},
            r"network\.3\.b is missing",
            id="more-layers",
        ),
    ],
)
def test_a_card_of_something_else_is_refused(tmp_path, changes, message):
    store(tmp_path)
    edit_card(tmp_path, **changes)
    with pytest.raises(UserError, match=message):
        load_native(tmp_path)


def test_weights_that_nobody_asked_for_are_refused(tmp_path):
    store(tmp_path)
    edit_weights(tmp_path, lambda weights: weights.update(extra=np.zeros(2, np.float32)))
    with pytest.raises(UserError, match=r"extra is unknown to the architecture"):
        load_native(tmp_path)


def test_weights_in_another_type_are_refused(tmp_path):
    store(tmp_path)
    edit_weights(tmp_path, lambda weights: weights.update(log_std=np.zeros(1, np.float64)))
    with pytest.raises(UserError, match="log_std is F64, but weights are F32"):
        load_native(tmp_path)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_weights_that_are_not_finite_are_refused(tmp_path, value):
    store(tmp_path)
    edit_weights(tmp_path, lambda weights: weights["network.0.w"].__setitem__((0, 0), value))
    with pytest.raises(UserError, match=r"network\.0\.w holds numbers that are not finite: train"):
        load_native(tmp_path)


def test_weights_of_another_save_are_refused(tmp_path):
    store(tmp_path / "a", untrained(TASK.human, seed=0))
    store(tmp_path / "b", untrained(TASK.human, seed=1))
    (tmp_path / "a" / WEIGHTS_FILE).replace(tmp_path / "b" / WEIGHTS_FILE)
    with pytest.raises(UserError, match=r"other weights than policy\.json describes"):
        load_native(tmp_path / "b")


def test_a_measurement_in_place_of_a_policy_is_called_what_it_is(tmp_path):
    (tmp_path / "frontier.json").touch()
    with pytest.raises(UserError, match=r"is a measurement \(frontier\.json\), not a policy: name"):
        load_card(tmp_path)
