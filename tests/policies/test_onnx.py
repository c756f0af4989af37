"""Robots that come as ONNX: memory of any layout, and one message for whatever is wrong."""

from __future__ import annotations

import sys

import cloudpickle
import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper

from rigid.errors import UserError
from rigid.policies.loading import load_policy, policy_hash
from rigid.tasks.protocol import AgentSpec
from tests.policies import graphs
from tests.policies.graphs import chain, linear, model, port, save, save_beside, summing
from tests.toys import ToyReach

TASK = ToyReach()
CHOOSING = ToyReach(name="toy-choosing")
CHOOSING.robot = AgentSpec(2, 2, choices=(2,))
SEEN = np.random.default_rng(0).standard_normal((4, 5, 2)).astype(np.float32)
"""Four steps of five worlds."""
FOLLOWING = 0.5 * (SEEN[..., 1:] - SEEN[..., :1])


def load(spec, task=TASK):
    return load_policy(spec, task=task, agent="robot")


def actions(policy, seen=SEEN):
    """What a policy does in an episode, [T, B, a]."""
    state, found = policy.initial_state(seen.shape[1]), []
    for observation in seen:
        action, state = policy.act(observation, state, None)
        found.append(action)
    return np.stack(found)


@pytest.mark.parametrize("batch", ["batch", None, 1])
def test_a_feed_forward_robot_acts_in_every_row(here, batch):
    policy = load(save(here / "arm.onnx", linear(batch=batch)))
    assert (policy.observation_size, policy.action_size) == (2, 1)
    np.testing.assert_allclose(actions(policy), np.clip(FOLLOWING, -1, 1), atol=1e-6)


@pytest.mark.parametrize(
    ("batch", "state"),
    [
        pytest.param("batch", [1, "batch", 1], id="layers-first"),
        pytest.param("batch", ["batch", 1, 1], id="worlds-first"),
        pytest.param("batch", [1, 1, 1], id="fixed-state"),
        pytest.param(1, [1, 1, 1], id="one-world"),
    ],
)
def test_memory_starts_at_zero_and_is_each_worlds_own(here, batch, state):
    built = summing(batch, state)
    if state[0] == "batch":  # The same sums with another axis in front.
        for node in built.graph.node:
            node.input[:] = ["last" if name == "first" else name for name in node.input]
        built.graph.initializer[1].CopyFrom(onnx.numpy_helper.from_array(np.array([1]), "last"))
    policy = load(save(here / "arm.onnx", built))
    np.testing.assert_allclose(
        actions(policy), np.clip(np.cumsum(FOLLOWING, axis=0), -1, 1), atol=1e-5
    )


def test_outputs_after_action_and_states_are_ignored(here):
    built = linear()
    built.graph.node.append(helper.make_node("Identity", ["action"], ["value"]))
    built.graph.output.append(port("value", ["batch", 1]))
    np.testing.assert_array_equal(
        actions(load(save(here / "a.onnx", built))),
        actions(load(save(here / "b.onnx", linear()))),
    )


@pytest.mark.parametrize("keepdims", [0, 1])
def test_a_chosen_number_becomes_scores(here, keepdims):
    out = port("action", ["batch"] if keepdims == 0 else ["batch", 1], TensorProto.INT64)
    node = helper.make_node("ArgMax", ["obs"], ["action"], axis=1, keepdims=keepdims)
    policy = load(
        save(here / "arm.onnx", model([port("obs", ["batch", 2])], [out], [node])), CHOOSING
    )
    np.testing.assert_array_equal(actions(policy).argmax(axis=2), SEEN.argmax(axis=2))


@pytest.mark.parametrize("size", [0.1, 1000])
def test_of_scores_of_any_size_the_largest_is_chosen(here, size):
    policy = load(
        save(here / "arm.onnx", linear(weight=size * np.eye(2, dtype=np.float32))), CHOOSING
    )
    np.testing.assert_array_equal(actions(policy).argmax(axis=2), SEEN.argmax(axis=2))


def test_a_robot_that_was_sent_to_another_process_acts_the_same(here):
    policy = load(save(here / "arm.onnx", summing("batch", [1, "batch", 1])))
    sent = cloudpickle.loads(cloudpickle.dumps(policy))
    (here / "arm.onnx").unlink()  # It carries all that it needs.
    np.testing.assert_array_equal(actions(sent), actions(policy))
    assert policy_hash(sent) == policy_hash(policy)


def test_the_hash_is_that_of_the_file(here):
    import hashlib

    spec = save(here / "arm.onnx", linear())
    assert policy_hash(load(spec)) == hashlib.sha256((here / "arm.onnx").read_bytes()).hexdigest()


def test_weights_beside_the_file_are_read_and_hashed(here):
    one = load(save_beside(here / "arm.onnx", linear()))
    np.testing.assert_allclose(actions(one), np.clip(FOLLOWING, -1, 1), atol=1e-6)
    (here / "weights.bin").write_bytes(bytes(8))
    other = load("arm.onnx")
    assert policy_hash(other) != policy_hash(one)
    np.testing.assert_array_equal(actions(other), 0.0)


@pytest.mark.parametrize("place", ["../secret.bin", "/etc/hostname", "link.bin"])
def test_weights_outside_of_the_folder_are_never_read(here, place):
    folder = here / "robots"
    folder.mkdir()
    (here / "secret.bin").write_bytes(bytes(8))
    (folder / "link.bin").symlink_to(here / "secret.bin")
    save_beside(folder / "arm.onnx", linear())
    built = onnx.load(folder / "arm.onnx", load_external_data=False)
    entry = built.graph.initializer[0].external_data[0]
    assert entry.key == "location"
    entry.value = place
    with pytest.raises(UserError, match=f"'w' lies in '{place}', outside of the model's folder"):
        load(save(folder / "arm.onnx", built))


def test_a_tensor_outside_hides_in_no_inner_graph(here):
    built, inner = linear(), linear()
    tensor = inner.graph.initializer[0]
    tensor.ClearField("raw_data")
    tensor.data_location = tensor.EXTERNAL
    tensor.external_data.add(key="location", value="../secret.bin")
    built.graph.node.append(helper.make_node("If", ["obs"], ["x"], then_branch=inner.graph))
    with pytest.raises(UserError, match=r"'w' lies in '../secret.bin', outside"):
        load(save(here / "arm.onnx", built))


def test_a_sparse_tensor_in_another_file_is_refused(here):
    built = linear()
    sparse = built.graph.sparse_initializer.add()
    sparse.dims.append(4)
    (here / "sparse.bin").write_bytes(bytes(16))
    for part, kind in ((sparse.values, onnx.TensorProto.FLOAT), (sparse.indices, 7)):
        part.name, part.data_type, part.data_location = "thin", kind, part.EXTERNAL
        part.dims.append(2)
        part.external_data.add(key="location", value="sparse.bin")
    with pytest.raises(UserError, match="tensor 'thin' lies in another file, from which onnx does"):
        load(save(here / "arm.onnx", built))


NO_MODEL = {
    "empty": (b"", r"arm\.onnx is empty: export it again"),
    "text": (b"hello\n" * 9, r"arm\.onnx is no ONNX file, or a truncated one: export it again"),
    "truncated": (linear().SerializeToString()[:90], "no ONNX file, or a truncated one"),
    "other-protobuf": (b"\x08\x07", r"cannot be opened by onnxruntime \S+ \(.*No graph was found"),
}


@pytest.mark.parametrize("name", NO_MODEL)
def test_a_file_that_is_no_model_is_refused(here, name):
    data, message = NO_MODEL[name]
    (here / "arm.onnx").write_bytes(data)
    with pytest.raises(UserError, match=message):
        load("arm.onnx")


def test_a_missing_file_and_a_folder_are_refused(here):
    with pytest.raises(UserError, match=r"arm\.onnx does not exist: name an ONNX file"):
        load("arm.onnx")
    (here / "arm.onnx").mkdir()
    with pytest.raises(UserError, match=r"policy\.json does not exist: a native policy is"):
        load("arm.onnx")


def growing():
    """A state that is wider after each step."""
    return model(
        [port("obs", ["batch", 2]), port("h", ["batch", 1])],
        [port("action", ["batch", 1]), port("h_next", ["batch", "wide"])],
        [
            helper.make_node("MatMul", ["obs", "w"], ["action"]),
            helper.make_node("Concat", ["action", "h"], ["h_next"], axis=1),
        ],
        {"w": graphs.WEIGHT},
    )


BAD = {
    "opset": (linear, {"opset": 99}, r"\(ONNX Runtime only .*Opset 99 .*\): export it again, with"),
    "observation": (
        lambda: linear(weight=np.ones((3, 1), np.float32)), {},
        "maps 3 observations to 1 actions, but the robot of 'toy-reach' maps 2 to 1: choose",
    ),
    "action": (
        lambda: linear(weight=np.ones((2, 4), np.float32)), {},
        "maps 2 observations to 4 actions, but the robot of 'toy-reach' maps 2 to 1: choose",
    ),
    "undeclared": (
        lambda: linear(weight=np.ones((3, 1), np.float32), sees="any"), {},
        r"onnxruntime cannot run arm.onnx \(.*\(shown 2 numbers, as the robot sees\)$",
    ),
    "integers": (
        lambda: model(
            [port("obs", ["batch", 2])], [port("action", ["batch"], TensorProto.INT64)],
            [helper.make_node("ArgMax", ["obs"], ["action"], axis=1, keepdims=0)],
        ), {}, "answers whole numbers, as for discrete actions, but the task takes 1 reals",
    ),
    "random": (
        lambda: chain("RandomNormalLike"), {},
        "answers the same observations in two ways: export its mean action",
    ),
    "mixing": (
        lambda: chain("CumSum", CumSum=np.array(0)), {},
        "answers differently in another row of the batch",
    ),
    "batch-of-8": (lambda: linear(batch=8), {}, r"takes exactly 8 worlds \('obs' \[8, 2\]\)"),
    "picture": (
        lambda: model(
            [port("obs", ["batch", 2, 3])], [port("action", ["batch", 2, 3])],
            [helper.make_node("Identity", ["obs"], ["action"])],
        ), {}, r"takes 'obs' \[batch, 2, 3\] of tensor\(float\) first, but the observation is",
    ),
    "words": (
        lambda: model(
            [port("obs", ["batch", 2], TensorProto.STRING)],
            [port("action", ["batch", 2], TensorProto.STRING)],
            [helper.make_node("Identity", ["obs"], ["action"])],
        ), {}, r"takes 'obs' \[batch, 2\] of tensor\(string\), but the inputs of a policy are",
    ),
    "open-state": (
        lambda: summing("batch", [1, "batch", "wide"]), {},
        r"takes the state 'h' \[1, batch, wide\], in which 2 sizes are open",
    ),
    "growing-state": (
        growing, {},
        r"takes the state 'h' \[batch, 1\], but gives 'h_next' of shape \(4, 2\) for \(4, 1\)",
    ),
    "state-without-end": (
        lambda: model(
            [port("obs", ["batch", 2]), port("h", ["batch", 1])], [port("action", ["batch", 2])],
            [helper.make_node("Add", ["obs", "h"], ["action"])],
        ), {}, r"takes 1 states \('h' \[batch, 1\]\), but gives 0: each state needs its output",
    ),
    "unknown-operator": (
        lambda: model(
            [port("obs", ["batch", 2])], [port("action", ["batch", 1])],
            [helper.make_node("Mine", ["obs"], ["action"], domain="my.operators")],
        ), {}, r"cannot be opened by onnxruntime .*my\.operators",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_a_graph_that_is_no_robot_of_this_task_is_refused(here, name):
    build, options, message = BAD[name]
    built = build()
    if options:
        built.opset_import[0].version = options["opset"]
    save(here / "arm.onnx", built)
    with pytest.raises(UserError, match=message):
        load("arm.onnx")


def test_actions_that_are_not_finite_name_robot_step_and_world(here):
    policy = load(save(here / "arm.onnx", chain("Sqrt")))
    state = policy.initial_state(2)
    _, state = policy.act(np.array([[0.0, 1.0], [0.0, 1.0]]), state, None)
    message = (
        r"^robot '\S+arm.onnx', step 2: answers actions that are not finite, in world 1: \[nan\]"
    )
    with pytest.raises(UserError, match=message):
        policy.act(np.array([[0.0, 1.0], [1.0, 0.0]]), state, None)


@pytest.mark.parametrize("missing", ["onnx", "onnxruntime"])
def test_without_the_extra_the_message_says_what_to_install(here, monkeypatch, missing):
    monkeypatch.setitem(sys.modules, missing, None)
    save(here / "arm.onnx", linear())
    message = rf"robot 'arm.onnx' needs {missing}: pip install 'rigid-frontier\[onnx\]'"
    with pytest.raises(UserError, match=message):
        load("arm.onnx")
