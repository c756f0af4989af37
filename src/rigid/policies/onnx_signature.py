"""What the inputs and outputs of an ONNX policy mean: observation, action, and states in pairs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Shaped

from rigid.errors import UserError

_KINDS = {
    "tensor(float)": np.float32,
    "tensor(double)": np.float64,
    "tensor(float16)": np.float16,
    "tensor(int64)": np.int64,
    "tensor(int32)": np.int32,
    "tensor(bool)": np.bool_,
}

Axis = int | str | None
"""A fixed size, the name of a dynamic one, or a dynamic one without a name."""


class Port(NamedTuple):
    """An input or output of a graph."""

    name: str
    kind: str
    """As onnxruntime writes it: tensor(float), …"""
    shape: tuple[Axis, ...]

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of its arrays.

        Raises:
            UserError: No policy deals in such things.
        """
        if self.kind not in _KINDS:
            raise UserError(
                f"takes {self} of {self.kind}, but the inputs of a policy are tensors of floats"
            )
        return np.dtype(_KINDS[self.kind])

    def __str__(self) -> str:
        sizes = ", ".join("?" if axis is None else str(axis) for axis in self.shape)
        return f"{self.name!r} [{sizes}]"


class StatePort(NamedTuple):
    """Something that the policy remembers: an output that becomes an input in the next step."""

    taken: Port
    given: str
    """Name of the output."""
    axis: int | None
    """Which axis of the input counts worlds; None where the graph takes one world at a time."""

    def start(self, batch: int) -> Shaped[np.ndarray, "B ..."]:
        """Zeros, worlds first."""
        sizes = (size for axis, size in enumerate(self.taken.shape) if axis != self.axis)
        fixed = (size if isinstance(size, int) else 1 for size in sizes)
        return np.zeros((batch, *fixed), self.taken.dtype)


class Signature(NamedTuple):
    """How a graph is to be called."""

    observation: Port
    action: str
    """Name of the output."""
    states: tuple[StatePort, ...]
    row_by_row: bool
    """Whether the graph takes one world at a time."""

    @property
    def observation_size(self) -> int | None:
        """Numbers that it sees; None where it takes any."""
        size = self.observation.shape[-1]
        return size if isinstance(size, int) else None


def read_signature(inputs: Sequence[Port], outputs: Sequence[Port]) -> Signature:
    """What inputs and outputs mean, by their order and their axes.

    The first input is the observation [B, o] and the first output the action. Input i + 1 is a
    state, and output i + 1 what it becomes; further outputs are ignored. The batch axis is the
    dynamic one. Where the observation is [1, o] or [o], or a state has no dynamic axis, the graph
    takes one world at a time.

    Raises:
        UserError: They mean nothing of that sort; the message goes on a sentence.
    """
    if not inputs or not outputs:
        raise UserError("has no input or no output: a policy maps an observation to an action")
    observation, taken = inputs[0], inputs[1:]
    batch = _batch_of(observation)
    if len(outputs) < len(inputs):
        raise UserError(
            f"takes {len(taken)} states ({', '.join(map(str, taken))}), but gives "
            f"{len(outputs) - 1}: each state needs its output after the action, in the same order"
        )
    axes = [_batch_axis(port) for port in taken]
    row_by_row = batch == 1 or None in axes
    states = tuple(
        StatePort(port, _becomes(port, out), None if row_by_row else axis)
        for port, out, axis in zip(taken, outputs[1:], axes, strict=False)
    )
    return Signature(observation, outputs[0].name, states, row_by_row)


def _batch_of(observation: Port) -> Axis:
    """How many worlds the graph takes."""
    if observation.dtype.kind != "f" or len(observation.shape) not in {1, 2}:
        raise UserError(
            f"takes {observation} of {observation.kind} first, but the observation is "
            "[batch, size] of floats"
        )
    batch = observation.shape[0] if len(observation.shape) == 2 else 1
    if isinstance(batch, int) and batch != 1:
        raise UserError(
            f"takes exactly {batch} worlds ({observation}): export it with a dynamic batch axis, "
            "or with one world"
        )
    return batch


def _batch_axis(state: Port) -> int | None:
    """The only dynamic axis of a state."""
    dynamic = [axis for axis, size in enumerate(state.shape) if not isinstance(size, int)]
    if len(dynamic) > 1:
        raise UserError(
            f"takes the state {state}, in which {len(dynamic)} sizes are open: only the batch axis "
            "may be dynamic"
        )
    return dynamic[0] if dynamic else None


def _becomes(state: Port, out: Port) -> str:
    """The output that a state becomes."""
    if out.kind != state.kind:
        raise UserError(
            f"takes the state {state} of {state.kind}, but gives {out} of {out.kind} for it: the "
            "outputs after the action are the states, in the order of the inputs"
        )
    return out.name
