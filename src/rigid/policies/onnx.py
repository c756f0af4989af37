"""Policies in ONNX, from whatever library; run by onnxruntime.

A model cannot run code, but for the operators that onnxruntime has.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Shaped

from rigid.errors import UserError
from rigid.policies.foreign import ForeignPolicy, Wanted, need_packages, open_model
from rigid.policies.onnx_contract import METADATA_KEY, check_contract
from rigid.policies.onnx_file import OnnxFile, read_onnx
from rigid.policies.onnx_signature import Axis, Port, Signature, StatePort, read_signature

_PLACE = re.compile(r"^\S*/\S+:\d+ .*?\) (?=[A-Z])")
"""Where in its source onnxruntime noticed something."""
_LONGEST = 300  # Characters of its words in a message. Ours.

Memory = tuple[Shaped[np.ndarray, "B ..."], ...]


def open_onnx(path: Path, wanted: Wanted) -> ForeignPolicy:
    """The policy in an ONNX file.

    Args:
        path: The file.
        wanted: Whom it acts for.

    Raises:
        UserError: onnxruntime is missing, the file is damaged, means nothing as a policy, or was
            exported by RIGID for another agent or task.
    """
    need_packages(wanted, "onnx", "onnx", "onnxruntime")
    model = OnnxModel(read_onnx(path), str(path))
    contract = model.session.get_modelmeta().custom_metadata_map.get(METADATA_KEY)
    if contract is not None:
        check_contract(contract, wanted)
    return open_model(model, wanted, model.signature.observation_size)


class OnnxModel:
    """A graph in a session of its own, on one thread; the session is opened where it is needed."""

    def __init__(self, file: OnnxFile, path: str) -> None:
        self._file, self._path = file, path
        self._session: Any = None
        inputs = [_port(node) for node in self.session.get_inputs()]
        outputs = [_port(node) for node in self.session.get_outputs()]
        try:
            self.signature: Signature = read_signature(inputs, outputs)
        except UserError as error:
            raise UserError(f"{path} {error}") from None

    def __getstate__(self) -> dict[str, Any]:
        """A session cannot be sent to another process: it is opened again there."""
        return {**self.__dict__, "_session": None}

    @property
    def session(self) -> Any:
        """The open session."""
        if self._session is None:
            self._session = _open(self._file.model, self._path)
        return self._session

    def begin(self, batch: int) -> Memory:
        """Zeros, with the worlds as the first axis."""
        return tuple(state.start(batch) for state in self.signature.states)

    def answer(
        self, observation: Float[np.ndarray, "B o"], memory: Memory, rng: object
    ) -> tuple[Shaped[np.ndarray, "..."], Memory]:
        """The first output, and what the states became."""
        del rng
        if not self.signature.row_by_row:
            return self._ask(observation, memory)
        answers = [
            self._ask_one(row, tuple(state[number] for state in memory))
            for number, row in enumerate(observation)
        ]
        actions, memories = zip(*answers, strict=True)
        return np.stack(actions), tuple(np.stack(states) for states in zip(*memories, strict=True))

    def fingerprint(self) -> str:
        """SHA-256 of the file's bytes."""
        return self._file.sha256

    def _ask(
        self, observation: Float[np.ndarray, "B o"], memory: Memory
    ) -> tuple[Shaped[np.ndarray, "..."], Memory]:
        states = self.signature.states
        moved = [
            np.ascontiguousarray(np.moveaxis(array, 0, state.axis or 0))
            for state, array in zip(states, memory, strict=True)
        ]
        action, became = self._run(observation, moved)
        after = tuple(
            np.moveaxis(array, state.axis or 0, 0) if array.ndim else array
            for state, array in zip(states, became, strict=True)
        )
        _check_states(states, memory, after)
        return action, after

    def _ask_one(
        self, observation: Float[np.ndarray, " o"], memory: Memory
    ) -> tuple[Shaped[np.ndarray, "..."], Memory]:
        seen = observation.reshape([1] * (len(self.signature.observation.shape) - 1) + [-1])
        action, became = self._run(seen, memory)
        _check_states(self.signature.states, memory, became)
        return action.reshape(-1), became

    def _run(self, observation: np.ndarray, memory: Any) -> tuple[np.ndarray, Memory]:
        """Calls the graph once."""
        states = self.signature.states
        seen = self.signature.observation
        given = {seen.name: observation.astype(seen.dtype)}
        given |= {state.taken.name: array for state, array in zip(states, memory, strict=True)}
        wanted = [self.signature.action, *(state.given for state in states)]
        try:
            action, *became = self.session.run(wanted, given)
        except Exception as error:  # noqa: BLE001 - onnxruntime's errors share no base class.
            raise UserError(f"onnxruntime cannot run {self._path} ({_short(error)})") from None
        return np.asarray(action), tuple(became)


def _check_states(states: tuple[StatePort, ...], before: Memory, after: Memory) -> None:
    for state, old, new in zip(states, before, after, strict=True):
        if old.shape != new.shape:
            raise UserError(
                f"takes the state {state.taken}, but gives {state.given!r} of shape {new.shape} "
                f"for {old.shape} (worlds first): both must be alike"
            )


def _open(model: bytes, path: str) -> Any:
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.use_deterministic_compute = True
    options.log_severity_level = 4  # What is wrong is said in our own message.
    providers = ["CPUExecutionProvider"]
    try:
        return onnxruntime.InferenceSession(model, options, providers=providers)
    except Exception as error:  # noqa: BLE001 - onnxruntime's errors share no base class.
        raise UserError(
            f"{path} cannot be opened by onnxruntime {onnxruntime.__version__} ({_short(error)}): "
            "export it again, with an operator set that this version knows"
        ) from None


def _port(node: Any) -> Port:
    shape: tuple[Axis, ...] = tuple(node.shape)
    return Port(node.name, node.type, shape)


def _short(error: Exception) -> str:
    """The first line of a message, without onnxruntime's preamble."""
    first = str(error).strip().partition("\n")[0].rpartition(" : ")[2]
    return _PLACE.sub("", first)[:_LONGEST] or type(error).__name__
