"""A native policy as an ONNX graph: normaliser, memory and clip inside, the contract in metadata.

Inputs and outputs, B worlds: `observation` [B, o] → `action` [B, a], the mean action: reals in
[-1, 1], or scores of choices, which are not clipped, since the task takes the largest. A policy
with memory K has two states as well, both zero before the first step: `history` [B, (K - 1) o], the
observations before, newest first, and `begun` [B, 1], 1 from the second step on (before it the
first observation stands for those that are missing). They become `history_next` and `begun_next`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid._version import __version__
from rigid.files import json_text
from rigid.policies.architecture import NativePolicy
from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.native import StoredPolicy
from rigid.policies.networks import OBSERVATION_CLIP, Layer, Normaliser
from rigid.policies.onnx_contract import METADATA_KEY, OnnxContract
from rigid.policies.palm import MotionEncoder
from rigid.tasks.protocol import AgentSpec

OPSET, IR_VERSION = 17, 8
"""Of ONNX 1.12, which everything since 2022 reads; nothing newer is needed. Ours."""


def to_onnx(stored: StoredPolicy, spec: AgentSpec) -> bytes:
    """The model of a native policy.

    Args:
        stored: Policy and card.
        spec: What its agent sees and does in the task it was trained for.
    """
    import onnx
    from onnx import helper

    policy = stored.policy
    graph = _Graph()
    window, states = _window(graph, policy)
    mean = _mean(graph, policy, window)
    if spec.choices:
        graph.node("Identity", mean, out="action")
    else:
        graph.node("Clip", mean, graph.constant(-1.0), graph.constant(1.0), out="action")
    wide = (policy.memory - 1) * policy.observation_size
    sizes = {"observation": policy.observation_size, "action": policy.action_size}
    sizes |= {"history": wide, "history_next": wide, "begun": 1, "begun_next": 1}

    def ports(*names: str) -> list[Any]:
        kind = onnx.TensorProto.FLOAT
        return [helper.make_tensor_value_info(name, kind, ["batch", sizes[name]]) for name in names]

    built = helper.make_graph(
        graph.nodes, "policy", ports("observation", *states),
        ports("action", *(f"{name}_next" for name in states)), graph.weights,
    )  # fmt: skip
    model = helper.make_model(
        built, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=IR_VERSION,
        producer_name="rigid-frontier", producer_version=__version__, doc_string=__doc__,
    )  # fmt: skip
    helper.set_model_props(model, {METADATA_KEY: json_text(_contract(stored, spec).model_dump())})
    onnx.checker.check_model(model, full_check=True)
    return bytes(model.SerializeToString())


def _contract(stored: StoredPolicy, spec: AgentSpec) -> OnnxContract:
    policy, card = stored
    return OnnxContract(
        agent=card.agent,
        task=card.task,
        observation_names=spec.observation_names,
        observation_size=policy.observation_size,
        action_size=policy.action_size,
        choices=spec.choices,
        memory=policy.memory,
        fingerprint=card.sha256,
        provenance=card.provenance,
    )


class _Graph:
    """Nodes and weights in the making; every method returns the name of what it adds."""

    def __init__(self) -> None:
        self.nodes: list[Any] = []
        self.weights: list[Any] = []

    def node(self, kind: str, *inputs: str, out: str | None = None, **attributes: Any) -> str:
        """A node with one output."""
        from onnx import helper

        name = out or f"{kind.lower()}_{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, list(inputs), [name], **attributes))
        return name

    def constant(self, value: Any, *, dtype: Any = np.float32) -> str:
        """A weight; a float32 unless `dtype` says otherwise."""
        from onnx import numpy_helper

        name = f"weight_{len(self.weights)}"
        self.weights.append(numpy_helper.from_array(np.array(value, dtype=dtype), name))
        return name

    def indices(self, *value: int) -> str:
        """Whole numbers, as slices and shapes want them."""
        return self.constant(value, dtype=np.int64)


def _window(graph: _Graph, policy: NativePolicy) -> tuple[str, tuple[str, ...]]:
    """The last observations, newest first (`stack_history`), and the names of the states."""
    size, memory = policy.observation_size, policy.memory
    if memory == 1:
        return "observation", ()
    first = graph.node("Concat", *["observation"] * (memory - 1), axis=1)
    begun = graph.node("Greater", "begun", graph.constant(0.0))
    past = graph.node("Where", begun, "history", first)
    window = graph.node("Concat", "observation", past, axis=1)
    ends = (graph.indices(0), graph.indices((memory - 1) * size), graph.indices(1))
    graph.node("Slice", window, *ends, out="history_next")
    graph.node("Max", "begun", graph.constant(1.0), out="begun_next")
    return window, ("history", "begun")


def _mean(graph: _Graph, policy: NativePolicy, window: str) -> str:
    """The mean action."""
    if isinstance(policy, GaussianPolicy):
        return _head(graph, policy.parameters, window)
    latent = _latent(graph, policy.parameters.encoder, window, policy.memory)
    seen = graph.node("Concat", "observation", latent, axis=1)
    return _head(graph, policy.parameters.head, seen)


def _head(graph: _Graph, parameters: GaussianParameters, seen: str) -> str:
    """`mean_action`."""
    x = _normalise(graph, parameters.normaliser, seen)
    for layer in parameters.network[:-1]:
        x = graph.node("Tanh", _affine(graph, layer, x))
    return _affine(graph, parameters.network[-1], x)


def _affine(graph: _Graph, layer: Layer, x: str) -> str:
    product = graph.node("MatMul", x, graph.constant(layer["w"]))
    return graph.node("Add", product, graph.constant(layer["b"]))


def _normalise(graph: _Graph, normaliser: Normaliser, x: str) -> str:
    """`normalise`."""
    scale = np.sqrt(np.asarray(normaliser.variance, np.float32) + np.float32(1e-6))
    centred = graph.node("Sub", x, graph.constant(normaliser.mean))
    scaled = graph.node("Div", centred, graph.constant(scale))
    low, high = graph.constant(-OBSERVATION_CLIP), graph.constant(OBSERVATION_CLIP)
    return graph.node("Clip", scaled, low, high)


def _latent(graph: _Graph, encoder: MotionEncoder, window: str, memory: int) -> str:
    """`encode`: the recurrent unit reads the window from its oldest observation on."""
    size = encoder.normaliser.mean.shape[0]
    steps = graph.node("Reshape", window, graph.indices(-1, memory, size))
    newest_first = graph.node("Transpose", steps, perm=[1, 0, 2])
    sequence = graph.node("Gather", newest_first, graph.indices(*reversed(range(memory))), axis=0)
    before = graph.node("Gather", sequence, graph.indices(0, *range(memory - 1)), axis=0)
    seen = _normalise(graph, encoder.normaliser, sequence)
    change = _normalise(graph, encoder.change, graph.node("Sub", sequence, before))
    inputs = graph.node("Concat", seen, change, axis=2)
    return _affine(graph, encoder.mean, _recurrent(graph, encoder.recurrent, inputs))


def _recurrent(graph: _Graph, unit: Layer, inputs: str) -> str:
    """The last state of `apply_gru` over a sequence, from zeros."""
    width = unit["u"].shape[0]
    w, u, b = (_gates(unit[key]) for key in "wub")
    bias = np.concatenate([b, np.zeros_like(b)])[None]
    arrays = (graph.constant(w.T[None]), graph.constant(u.T[None]), graph.constant(bias))
    last = f"state_{len(graph.nodes)}"
    # ONNX's candidate is ours when the reset gate comes after the product.
    graph.node("GRU", inputs, *arrays, hidden_size=width, linear_before_reset=1, out=last)
    graph.nodes[-1].output[:] = ["", last]  # Its second output is the last state, [1, B, h].
    return graph.node("Squeeze", last, graph.indices(0))


def _gates(block: Any) -> np.ndarray:
    """Reset, update, candidate, as ours are, in ONNX's order: update, reset, candidate."""
    reset, update, candidate = np.split(np.asarray(block, np.float32), 3, axis=-1)
    return np.concatenate([update, reset, candidate], axis=-1)
