"""Native policies as ONNX: the same actions all through an episode, and a contract that is kept."""

from __future__ import annotations

import json

import numpy as np
import onnx
import pytest

from rigid.errors import UserError
from rigid.policies.architecture import NativePolicy
from rigid.policies.loading import BUNDLED, load_policy
from rigid.policies.native import load_native, save_policy
from rigid.policies.networks import Normaliser
from rigid.policies.onnx import OnnxModel
from rigid.policies.onnx_export import to_onnx
from rigid.policies.onnx_file import OnnxFile
from rigid.tasks.protocol import AgentSpec
from tests.policies.graphs import linear, save
from tests.toys import ToyReach, untrained, untrained_palm

TASK = ToyReach()


def with_normaliser(policy: NativePolicy) -> NativePolicy:
    """The policy behind a normaliser that matters."""
    head = policy.parameters if hasattr(policy.parameters, "network") else policy.parameters.head
    size = head.normaliser.mean.shape[0]
    rng = np.random.default_rng(5)
    moments = (rng.normal(size=size), 0.1 + rng.random(size), np.array(9.0))
    changed = head._replace(normaliser=Normaliser(*(np.float32(m) for m in moments)))
    if head is policy.parameters:
        return type(policy)(changed, memory=policy.memory)
    return type(policy)(policy.parameters._replace(head=changed), memory=policy.memory)


def exported(folder, policy, agent="robot", task=TASK):
    """A policy on disk, and its model."""
    save_policy(policy, folder / "native", agent=agent, task=task.describe(), provenance={"n": 1})
    stored = load_native(folder / "native")
    (folder / "model.onnx").write_bytes(to_onnx(stored, getattr(task, agent)))
    return stored, str(folder / "model.onnx")


POLICIES = {
    "gaussian": lambda spec: untrained(spec, seed=1),
    "gaussian-memory-3": lambda spec: untrained(spec, seed=2, memory=3),
    "palm-memory-4": lambda spec: untrained_palm(spec, seed=3),
    "palm-memory-1": lambda spec: untrained_palm(spec, seed=3, memory=1),
}


@pytest.mark.parametrize("agent", ["robot", "human"])
@pytest.mark.parametrize("name", POLICIES)
def test_an_exported_policy_acts_as_the_native_one_all_through_an_episode(tmp_path, name, agent):
    native, path = exported(tmp_path, with_normaliser(POLICIES[name](getattr(TASK, agent))), agent)
    model = load_policy(path, task=TASK, agent=agent)
    rng = np.random.default_rng(0)
    mine, theirs = native.policy.initial_state(6), model.initial_state(6)
    for _ in range(8):
        seen = 3 * rng.standard_normal((6, model.observation_size)).astype(np.float32)
        action, mine = native.policy.act(seen, mine, None)
        other, theirs = model.act(seen, theirs, None)
        np.testing.assert_allclose(other, np.clip(action, -1, 1), rtol=0, atol=1e-5)


def test_an_exported_policy_chooses_as_the_native_one(tmp_path):
    task = ToyReach()
    task.robot = AgentSpec(2, 20, choices=(20,))
    native, path = exported(tmp_path, untrained_palm(task.robot, seed=3), task=task)
    model, policy = load_policy(path, task=task, agent="robot"), native.policy
    seen = 9 * np.random.default_rng(0).standard_normal((200, 2)).astype(np.float32)
    mine, _ = policy.act(seen, policy.initial_state(200), None)
    assert ((mine > 1).sum(axis=1) > 1).any()
    theirs, _ = model.act(seen, model.initial_state(200), None)
    np.testing.assert_array_equal(theirs.argmax(axis=1), mine.argmax(axis=1))


def test_the_bundled_robot_acts_the_same_in_onnx():
    stored = load_native(BUNDLED / "itch-scratching" / "vanilla")
    size = stored.policy.observation_size
    data = to_onnx(stored, AgentSpec(size, stored.policy.action_size))
    model = OnnxModel(OnnxFile(data, ""), "vanilla.onnx")
    seen = np.random.default_rng(0).standard_normal((50, size)).astype(np.float32)
    mine, _ = stored.policy.act(seen, stored.policy.initial_state(50), None)
    other, _ = model.answer(seen, model.begin(50), None)
    np.testing.assert_allclose(other, np.clip(mine, -1, 1), rtol=0, atol=1e-5)


def test_the_metadata_say_what_goes_in_and_out_and_where_it_came_from(tmp_path):
    stored, path = exported(tmp_path, untrained(TASK.robot, memory=3))
    built = onnx.load(path)
    (entry,) = built.metadata_props
    contract = json.loads(entry.value)
    assert entry.key == "rigid"
    assert contract["observation_names"] == ["robot", "hand"]
    assert (contract["observation_size"], contract["action_size"], contract["memory"]) == (2, 1, 3)
    assert contract["task"] == TASK.describe()
    assert contract["fingerprint"] == stored.card.sha256
    assert contract["provenance"] == {"n": 1}
    assert contract["normaliser"] == "inside"
    assert [port.name for port in built.graph.input] == ["observation", "history", "begun"]
    assert [port.name for port in built.graph.output] == ["action", "history_next", "begun_next"]


def test_equal_policies_give_equal_files(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    exported(tmp_path / "a", untrained(TASK.robot))
    exported(tmp_path / "b", untrained(TASK.robot))
    files = [tmp_path / name / "model.onnx" for name in "ab"]
    assert files[0].read_bytes() == files[1].read_bytes()


def changed(path, **fields):
    """The model with other metadata."""
    built = onnx.load(path)
    (entry,) = built.metadata_props
    entry.value = json.dumps({**json.loads(entry.value), **fields})
    return built


BAD = {
    "other-agent": ({"agent": "human"}, "is a policy of the human: choose a robot's"),
    "other-task": (
        {"task": {"name": "feeding"}},
        "was trained for task 'feeding', not 'toy-reach'",
    ),
    "other-order": (
        {"observation_names": ["hand", "robot"]},
        "was exported to see 'hand' as observation 0, but the task shows 'robot' there",
    ),
    "newer": ({"format": 9}, "metadata 'rigid' has format version 9, but this RIGID reads up to 1"),
    "odd": ({"agent": "dog"}, "metadata 'rigid': agent: .*: export it again"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_model_that_was_exported_for_something_else_is_refused(tmp_path, name):
    fields, message = BAD[name]
    _, path = exported(tmp_path, untrained(TASK.robot))
    save(tmp_path / "model.onnx", changed(path, **fields))
    with pytest.raises(UserError, match=message):
        load_policy(path, task=TASK, agent="robot")


def test_metadata_of_others_are_nobodys_contract(tmp_path):
    built = linear()
    built.metadata_props.add(key="made_by", value="somebody")
    policy = load_policy(save(tmp_path / "arm.onnx", built), task=TASK, agent="robot")
    assert policy.action_size == 1
