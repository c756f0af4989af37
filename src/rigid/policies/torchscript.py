"""TorchScript policies. Opening one can run code of its maker, so it takes `--trust`."""

from __future__ import annotations

import hashlib
import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Shaped

from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.policies.foreign import ForeignPolicy, Wanted, first_line, need_packages, open_model
from rigid.policies.opening import Opening


def open_torchscript(path: Path, wanted: Wanted, opening: Opening) -> ForeignPolicy:
    """The policy in a TorchScript file.

    It is called as `module(observation)`, or as `module(observation, *state)` where it has a method
    `initial_state(batch)` that returns a tensor or a tuple of tensors, worlds first; it returns the
    action, or a tuple of the action and what the states became.

    Raises:
        UserError: The user does not trust it, torch is missing, or it is no such policy.
    """
    opening.need_trust(wanted.label, "a TorchScript file")
    need_packages(wanted, "sb3", "torch")
    data = read_bytes(path, cure="name a TorchScript file")
    return open_model(TorchScriptModel(data, str(path)), wanted, None)


class TorchScriptModel:
    """A scripted module; loaded where it is needed."""

    def __init__(self, data: bytes, path: str) -> None:
        self._data, self._path = data, path
        self._module: Any = None

    def __getstate__(self) -> dict[str, Any]:
        """A scripted module cannot be pickled: it is loaded again."""
        return {**self.__dict__, "_module": None}

    @property
    def module(self) -> Any:
        """The loaded module."""
        if self._module is None:
            self._module = _load(self._data, self._path)
        return self._module

    def begin(self, batch: int) -> tuple[Any, ...]:
        """The states before the first step, tensors."""
        if not hasattr(self.module, "initial_state"):
            return ()
        return _tuple(self._call(self.module.initial_state, batch))

    def answer(
        self, observation: Float[np.ndarray, "B o"], memory: tuple[Any, ...], rng: object
    ) -> tuple[Shaped[np.ndarray, "..."], tuple[Any, ...]]:
        """The action, and what the states became."""
        import torch

        del rng
        seen = torch.as_tensor(np.asarray(observation, np.float32))
        action, *became = _tuple(self._call(self.module, seen, *memory))
        if memory and len(became) != len(memory):
            raise UserError(
                f"takes {len(memory)} states but returns {len(became)} beside the action"
            )
        return action.numpy(), tuple(became) if memory else ()

    def fingerprint(self) -> str:
        """SHA-256 of the file's bytes."""
        return hashlib.sha256(self._data).hexdigest()

    def _call(self, function: Any, *arguments: Any) -> Any:
        import torch

        try:
            with torch.no_grad():
                return function(*arguments)
        except (RuntimeError, TypeError) as error:  # torch.jit.Error is a RuntimeError.
            last = str(error).strip().splitlines()[-1]
            raise UserError(f"torch cannot run {self._path} ({last})") from None


def _load(data: bytes, path: str) -> Any:
    import torch

    torch.set_num_threads(1)  # One for each worker process; also the same sums everywhere.
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # Of TorchScript as such.
            module = torch.jit.load(io.BytesIO(data), map_location="cpu")
    except (RuntimeError, ValueError) as error:
        raise UserError(
            f"{path} is no TorchScript file, or a truncated one ({first_line(error)}): write it "
            "again with torch.jit.script(…).save(…)"
        ) from None
    module.eval()
    return module


def _tuple(value: Any) -> tuple[Any, ...]:
    return tuple(value) if isinstance(value, tuple | list) else (value,)
