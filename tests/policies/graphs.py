"""Small ONNX graphs for the toy robot, which sees (robot, hand) and moves on a line."""

from __future__ import annotations

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

WEIGHT = np.array([[-0.5], [0.5]], np.float32)
"""Follows the hand: action = (hand - robot) / 2."""


def port(name, shape, kind=TensorProto.FLOAT):
    """An input or output."""
    return helper.make_tensor_value_info(name, kind, shape)


def model(inputs, outputs, nodes, weights=None, *, opset=17):
    """A model of these parts; `weights` by name."""
    arrays = [numpy_helper.from_array(np.asarray(w), n) for n, w in (weights or {}).items()]
    graph = helper.make_graph(nodes, "policy", inputs, outputs, arrays)
    imports = [helper.make_opsetid("", opset)]
    return helper.make_model(graph, opset_imports=imports, ir_version=8)


def linear(*, batch="batch", weight=WEIGHT, sees=None):
    """action = observation · weight."""
    return model(
        [port("obs", [batch, sees or len(weight)])], [port("action", [batch, weight.shape[1]])],
        [helper.make_node("MatMul", ["obs", "w"], ["action"])], {"w": weight},
    )  # fmt: skip


def summing(batch, state, *, becomes=None):
    """Adds up what `linear` says, in a state [layers = 1, batch, 1], as of recurrent layers."""
    nodes = [
        helper.make_node("MatMul", ["obs", "w"], ["now"]),
        helper.make_node("Unsqueeze", ["now", "first"], ["now_1"]),
        helper.make_node("Add", ["now_1", "h"], ["h_next"]),
        helper.make_node("Squeeze", ["h_next", "first"], ["action"]),
    ]
    return model(
        [port("obs", [batch, 2]), port("h", state)],
        [port("action", [batch, 1]), port("h_next", becomes or state)],
        nodes, {"w": WEIGHT, "first": np.array([0])},
    )  # fmt: skip


def chain(*kinds, out=None, **weights):
    """`linear`, and then one operator after the other; each may take the weight of its name."""
    nodes = [helper.make_node("MatMul", ["obs", "w"], ["x0"])]
    for number, kind in enumerate(kinds):
        last = "action" if number == len(kinds) - 1 else f"x{number + 1}"
        extra = [kind] if kind in weights else []
        nodes.append(helper.make_node(kind, [f"x{number}", *extra], [last]))
    return model(
        [port("obs", ["batch", 2])], [out or port("action", ["batch", 1])], nodes,
        {"w": WEIGHT, **weights},
    )  # fmt: skip


def save(path, built):
    """Writes a model, and returns what names it."""
    path.write_bytes(built.SerializeToString())
    return str(path)


def save_beside(path, built, name="weights.bin"):
    """Writes a model whose weights lie in another file."""
    onnx.save(built, path, save_as_external_data=True, location=name, size_threshold=0)
    return str(path)
