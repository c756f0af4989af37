"""Policies that are Python objects of the user's: `python:MODULE:FACTORY`.

Importing runs code; but the user wrote the name on the command line.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from jaxtyping import Float, Shaped

from rigid.errors import UserError
from rigid.factories import call_factory, find_module, told
from rigid.policies.foreign import ForeignPolicy, Wanted, open_model
from rigid.policies.protocol import Fingerprinted


def open_python(place: str, wanted: Wanted) -> ForeignPolicy:
    """The policy that `FACTORY()` of `MODULE` gives; it is asked a few times.

    The module is looked for in the working directory, then among what is installed. The object has
    `initial_state(batch)` and `act(observation, state, rng)`, as in `rigid.policies.protocol`. Its
    `observation_size` and `action_size` are checked where it has them.

    Args:
        place: `MODULE:FACTORY`.
        wanted: Whom it acts for.

    Raises:
        UserError: There is no such module or factory, it fails, or gives something else.
    """
    model = PythonModel(place)
    policy = open_model(model, wanted, model.size("observation_size"))
    stated = model.size("action_size")
    if stated not in {None, policy.action_size}:
        raise UserError(
            f"{wanted.label} states action_size {stated}, but answers {policy.action_size} numbers"
        )
    return policy


class PythonModel:
    """Somebody's object; other processes make their own with the factory."""

    def __init__(self, place: str) -> None:
        self._name, self._folder = f"python:{place}", str(Path.cwd())
        self._made: Any = None
        self._source = self._read_source()

    def __getstate__(self) -> dict[str, Any]:
        """What it holds may not be sent to another process: it is made again there."""
        return {**self.__dict__, "_made": None}

    @property
    def object(self) -> Any:
        """The policy."""
        if self._made is None:
            self._made = self._make()
            if self._read_source() != self._source:
                raise UserError(f"{self._name}: its source was changed in the meantime")
        return self._made

    def size(self, name: str) -> int | None:
        """A size that the object states; None if it does not."""
        found = getattr(self.object, name, None)
        if found is None:
            return None
        if isinstance(found, bool) or not isinstance(found, int | np.integer) or found < 1:
            raise UserError(f"{self._name}: {name} is {found!r}, but must be a whole number from 1")
        return int(found)

    def begin(self, batch: int) -> Any:
        """The object's state before the first step."""
        return self._call("initial_state", batch)

    def answer(
        self, observation: Float[np.ndarray, "B o"], memory: Any, rng: np.random.Generator | None
    ) -> tuple[Shaped[np.ndarray, "..."], Any]:
        """The object's action and next state."""
        found = self._call("act", observation, memory, rng)
        if not isinstance(found, tuple) or len(found) != 2:
            raise UserError(
                f"act returned a {type(found).__name__}, but must return (action, state)"
            )
        action, after = found
        return np.asarray(action), after

    def fingerprint(self) -> str:
        """SHA-256 over the name and the bytes of the module's file; see docs/policies.md."""
        digest = hashlib.sha256(f"{self._name}\0".encode() + self._source)
        if isinstance(self.object, Fingerprinted):
            digest.update(self.object.fingerprint().encode())
        return digest.hexdigest()

    def _read_source(self) -> bytes:
        return Path(str(self._module().__file__)).read_bytes()

    def _module(self) -> ModuleType:
        """The module, imported."""
        module = find_module(self._name, self._folder)
        if module.__file__ is None:
            raise UserError(f"{self._name}: {module.__name__!r} is a folder, no module")
        return module

    def _make(self) -> Any:
        """What the factory gives."""
        made = call_factory(self._name, self._folder)
        for method in ("initial_state", "act"):
            if not callable(getattr(made, method, None)):
                raise UserError(
                    f"{self._name} gives a {type(made).__name__} without {method}(…): a "
                    "policy has initial_state(batch) and act(observation, state, rng)"
                )
        return made

    def _call(self, method: str, *arguments: Any) -> Any:
        try:
            return getattr(self.object, method)(*arguments)
        except UserError:
            raise
        except Exception as error:  # noqa: BLE001 - It is the user's code, which may raise anything.
            raise UserError(f"{method} fails: {told(error)}") from None
