"""Discrete actions as RIGID has them: a score for each choice, of which the task takes the largest.

Policies of other libraries answer with the numbers of their choices, or with reals; either becomes
what a `rigid.policies.protocol.Policy` returns.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Integer, Shaped

from rigid.tasks.protocol import AgentSpec


def scores_of(
    choice: Integer[np.ndarray, "B *k"], choices: Sequence[int]
) -> Float[np.ndarray, "B a"]:
    """A score of 1 for what was chosen and −1 for everything else.

    Args:
        choice: The number of the choice in each world, from 0: shape (B,), or (B, k) for k discrete
            actions side by side.
        choices: How many choices each discrete action has, k of them.

    Raises:
        ValueError: There is no such choice, or another number of actions than `choices` says.

    Example:
        >>> scores_of(np.array([2, 0]), (3,))
        array([[-1., -1.,  1.],
               [ 1., -1., -1.]])
    """
    columns = choice.reshape(len(choice), -1)
    if columns.shape[1] != len(choices) or choice.ndim > 2:
        raise ValueError(
            f"chooses {_shape(choice)} numbers, but there are {len(choices)} discrete actions, of "
            f"{_listed(choices)} choices"
        )
    bad = np.argwhere((columns < 0) | (columns >= np.asarray(choices)))
    if len(bad):
        row, which = (int(number) for number in bad[0])
        raise ValueError(
            f"chooses {columns[row, which]}, but the choices are 0 to {choices[which] - 1}"
        )
    blocks = [
        2.0 * (column[:, None] == np.arange(count)) - 1.0
        for column, count in zip(columns.T, choices, strict=True)
    ]
    return np.concatenate(blocks, axis=1)


def actions_of(
    answer: Shaped[np.ndarray, "..."], spec: AgentSpec, batch: int
) -> Float[np.ndarray, "B a"]:
    """What a policy of any library answered, as actions in [-1, 1].

    Args:
        answer: Reals (B, a), or (B,) for a single one; or whole numbers as in `scores_of`.
        spec: What the agent does.
        batch: B.

    Raises:
        ValueError: The answer has another shape or kind than the agent's actions, or a number that
            is not finite; the message goes on a sentence that begins with the policy's name.
    """
    if answer.dtype.kind in "biu":
        if not spec.choices:
            raise ValueError(
                "answers whole numbers, as for discrete actions, but the task takes "
                f"{spec.action_size} reals in [-1, 1]"
            )
        if answer.ndim == 0 or len(answer) != batch:
            raise ValueError(f"answers {_shape(answer)} choices for {batch} worlds")
        return scores_of(answer.astype(np.int64), spec.choices)
    if answer.dtype.kind != "f":
        raise ValueError(f"answers {answer.dtype}, but actions are numbers")
    if answer.shape == (batch,) and spec.action_size == 1:
        answer = answer[:, None]
    if answer.shape != (batch, spec.action_size):
        hint = f", or whole numbers for {_listed(spec.choices)} choices" if spec.choices else ""
        raise ValueError(
            f"answers an array of shape {_shape(answer)}, but the task takes "
            f"({batch}, {spec.action_size}){hint}"
        )
    broken = np.flatnonzero(~np.isfinite(answer).all(axis=1))
    if len(broken):
        shown = np.array2string(answer[broken[0]], precision=3, threshold=8)
        raise ValueError(f"answers actions that are not finite, in world {broken[0]}: {shown}")
    return taken(answer.astype(np.float64), spec)


def taken(action: Float[np.ndarray, "*n a"], spec: AgentSpec) -> Float[np.ndarray, "*n a"]:
    """What a task makes of an action, in [-1, 1]: clipped reals, or what the largest scores choose.

    Scores are compared before anything is clipped, or all beyond 1 would be alike.

    Example:
        >>> taken(np.array([0.5, 2.0, 3.0]), AgentSpec(1, 3))
        array([0.5, 1. , 1. ])
        >>> taken(np.array([0.5, 2.0, 3.0]), AgentSpec(1, 3, choices=(3,)))
        array([-1., -1.,  1.])
    """
    if not spec.choices:
        clipped: np.ndarray = np.clip(action, -1.0, 1.0)
        return clipped
    rows = action.reshape(-1, spec.action_size)
    scores, every, start = np.full_like(rows, -1.0), np.arange(len(rows)), 0
    for count in spec.choices:
        scores[every, start + rows[:, start : start + count].argmax(axis=1)] = 1.0
        start += count
    return scores.reshape(action.shape)


def _shape(array: np.ndarray) -> str:
    return str(array.shape)


def _listed(choices: Sequence[int]) -> str:
    return " and ".join(map(str, choices))
