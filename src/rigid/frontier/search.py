"""RIGID's search over λ (paper, Alg. 1): rounds of refinement where naturalness jumps."""

from __future__ import annotations

from collections.abc import Sequence

from rigid.frontier.largest_jump import first_lambdas, largest_jump, next_lambdas

JUMP_WINDOW = 2
"""Sliding window of LARGEST-JUMP, in points. Ours: the paper gives no value."""


def next_round(
    trained: Sequence[Sequence[float]],
    naturalness: Sequence[Sequence[float]],
    *,
    per_round: Sequence[int],
    lambda_min: float,
    lambda_max: float,
) -> list[float] | None:
    """The λ to train next, or None when the search is over.

    Args:
        trained: λ of each round so far.
        naturalness: Headline naturalness of each, on selection episodes, same shape.
        per_round: New λ in each round.
        lambda_min: Smallest λ of the first round.
        lambda_max: Largest λ of the first round.

    Example:
        >>> rounds = {"per_round": (3, 1), "lambda_min": 0.01, "lambda_max": 1.0}
        >>> next_round([], [], **rounds)
        [0.01, 0.1, 1.0]
        >>> [round(x, 4) for x in next_round([[0.01, 0.1, 1.0]], [[0.0, 0.1, 0.9]], **rounds)]
        [0.3162]
        >>> next_round([[0.01, 0.1, 1.0], [0.3162]], [[0.0, 0.1, 0.9], [0.5]], **rounds)
    """
    number = len(trained)
    if number == len(per_round):
        return None
    if number == 0:
        return first_lambdas(lambda_min, lambda_max, per_round[0])
    seen = [value for values in trained for value in values]
    scores = [value for values in naturalness for value in values]
    interval = largest_jump(seen, scores, JUMP_WINDOW)
    return next_lambdas(seen, interval, per_round[number])
