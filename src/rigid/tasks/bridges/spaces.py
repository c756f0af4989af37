"""Spaces of Gymnasium as rows of numbers: what an agent sees, and what it does, in [-1, 1]."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
from gymnasium import Space, spaces
from gymnasium.spaces.utils import flatdim, flatten
from jaxtyping import Float, Float32

from rigid.errors import UserError
from rigid.policies.discrete import taken
from rigid.tasks.protocol import AgentSpec

_SEEN = (spaces.Box, spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)


@dataclass(frozen=True)
class Sight:
    """An observation space whose observations become rows of numbers.

    `Dict` and `Tuple` are joined in their own order, which Gymnasium fixes; a discrete number is
    one-hot.
    """

    space: Space[Any]
    names: tuple[str, ...]
    """Of each number: the keys that lead to it, and its place."""

    @property
    def size(self) -> int:
        """How many numbers there are."""
        return len(self.names)

    def row(self, observation: Any) -> Float32[np.ndarray, " n"]:
        """An observation as numbers, as it is: nothing is scaled or clipped.

        Raises:
            ValueError: It has another size than its space.
        """
        row = np.asarray(flatten(self.space, observation), dtype=np.float32).reshape(-1)
        if len(row) != self.size:
            raise ValueError(f"an observation has {len(row)} numbers, but its space {self.size}")
        return row


def sight_of(space: Any, owner: str) -> Sight:
    """How `owner`'s observations are read.

    Raises:
        UserError: The space, or a part of it, has no fixed number of numbers.

    Example:
        >>> space = spaces.Dict({"hand": spaces.Box(-1, 1, (2,)), "itch": spaces.Discrete(2)})
        >>> sight_of(space, "human").names
        ('hand_0', 'hand_1', 'itch_0', 'itch_1')
    """
    return Sight(space, _names(space, "", owner))


def _names(space: Any, key: str, owner: str) -> tuple[str, ...]:
    if isinstance(space, spaces.Dict | spaces.Tuple):
        parts = space.items() if isinstance(space, spaces.Dict) else enumerate(space.spaces)
        found: list[str] = []
        for name, part in parts:
            found += _names(part, f"{key}_{name}" if key else str(name), owner)
        return tuple(found)
    if not isinstance(space, _SEEN):
        raise UserError(
            f"observation space {_shown(space)} of {owner} is not supported: use Box, Discrete, "
            "MultiDiscrete, MultiBinary, or a Dict or Tuple of them"
        )
    name, size = key or "observation", int(flatdim(space))
    if size == 1 and key:
        return (name,)
    return tuple(f"{name}_{number}" for number in range(size))


@dataclass(frozen=True)
class Deed:
    """An action space, acted in by reals in [-1, 1].

    A `Box` is stretched to [-1, 1]; of a discrete action each choice has a score, and the largest
    is taken.
    """

    space: spaces.Box | spaces.Discrete | spaces.MultiDiscrete | spaces.MultiBinary
    size: int
    choices: tuple[int, ...]
    """Of the discrete actions side by side; empty for a Box."""

    def action(self, row: Float[np.ndarray, " a"]) -> Any:
        """The action in the environment's own terms."""
        if isinstance(self.space, spaces.Box):
            return self._stretched(self.space, row)
        chosen = self._chosen(row)
        if isinstance(self.space, spaces.Discrete):
            return self.space.start + chosen[0].astype(self.space.dtype)
        whole = chosen.reshape(self.space.shape)
        if isinstance(self.space, spaces.MultiDiscrete):
            whole += self.space.start
        return whole.astype(self.space.dtype)

    def shown(self, row: Float[np.ndarray, " a"]) -> Float32[np.ndarray, " a"]:
        """The action as an onlooker sees it: what was chosen (1, else -1), never the scores."""
        return taken(row, AgentSpec(0, self.size, choices=self.choices)).astype(np.float32)

    def _chosen(self, row: np.ndarray) -> np.ndarray:
        ends = accumulate(self.choices)  # `np.split` takes as long as a small environment's step.
        return np.array([
            row[end - count : end].argmax()
            for end, count in zip(ends, self.choices, strict=True)
        ])  # fmt: skip

    @staticmethod
    def _stretched(box: spaces.Box, row: np.ndarray) -> np.ndarray:
        low, high = (bound.astype(np.float64) for bound in (box.low, box.high))
        share = (np.clip(row, -1.0, 1.0).astype(np.float64).reshape(box.shape) + 1) / 2
        wanted = low + share * (high - low)
        if np.issubdtype(box.dtype, np.integer):
            wanted = np.rint(wanted)
        # Rounding to the space's type must not leave the space.
        return np.asarray(np.clip(wanted.astype(box.dtype), box.low, box.high))


def deed_of(space: Any, owner: str) -> Deed:
    """How `owner` acts.

    Raises:
        UserError: The space is another one, or a Box without finite bounds.

    Example:
        >>> deed_of(spaces.Discrete(3), "human").action(np.array([-0.2, 0.9, 0.1]))
        np.int64(1)
    """
    if isinstance(space, spaces.Box):
        if not (np.isfinite(space.low).all() and np.isfinite(space.high).all()):
            raise UserError(
                f"action space {_shown(space)} of {owner} has no finite bounds, so that [-1, 1] "
                "stands for nothing: bound it, as gymnasium.wrappers.RescaleAction does"
            )
        return Deed(space, int(np.prod(space.shape)), ())
    if isinstance(space, spaces.Discrete):
        choices: tuple[int, ...] = (int(space.n),)
    elif isinstance(space, spaces.MultiDiscrete):
        choices = tuple(int(n) for n in space.nvec.reshape(-1))
    elif isinstance(space, spaces.MultiBinary):
        choices = (2,) * int(np.prod(space.shape))
    else:
        raise UserError(
            f"action space {_shown(space)} of {owner} is not supported: use Box, Discrete, "
            "MultiDiscrete or MultiBinary"
        )
    return Deed(space, sum(choices), choices)


def _shown(space: Any) -> str:
    text = " ".join(str(space).split())
    return text if len(text) <= 80 else f"{text[:77]}..."
