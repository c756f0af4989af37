"""Whether the training of an adversary had come to rest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np


def convergence(history: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Whether training had come to rest, from the last fifth of the iterations (ours).

    `converged`: the return moved by less than one standard deviation of its iteration-to-iteration
    noise between the two halves of that fifth, and the discriminator still errs on some adversary
    rows or none of them look canonical (it neither collapsed nor froze); a measure without a
    discriminator has none that could. A single iteration shows no rest, and its drift is None.
    """
    window = max(len(history) // 5, 2)
    tail = history[-window:]
    returns = np.array([row["mean_return"] for row in tail])
    half = len(returns) // 2
    drift = float(returns[half:].mean() - returns[:half].mean()) if half else None
    noise = float(np.abs(np.diff(returns)).mean()) if half else 0.0
    rested = drift is not None and abs(drift) <= max(noise, 1e-9)
    accuracy = {
        side: _mean([row[f"accuracy_{side}"] for row in tail])
        for side in ("canonical", "adversary")
    }
    alert = accuracy["canonical"] is None or accuracy["canonical"] > 0.5
    return {
        "converged": bool(rested and alert),
        "return_drift": drift,
        "accuracy_canonical": accuracy["canonical"],
        "accuracy_adversary": accuracy["adversary"],
        "entropy": float(tail[-1]["entropy"]),
    }


def _mean(values: Sequence[float | None]) -> float | None:
    """None where one is unknown."""
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if len(known) == len(values) else None
