"""Step 1 of the paper: key features, which have to vary in canonical play to tell anything."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.doctor.verdict import Verdict, listed

_CONSTANT = 1e-6
"""Deviation below which a feature counts as constant; as a share of its size from 1 on. The
whitening of every judge leaves the same ones unscaled (`naturalness.standardise`)."""
_BAND = (0.05, 0.95)


def check_features(
    names: Sequence[str],
    canonical: Float[np.ndarray, "E T f"],
    others: Mapping[str, Float[np.ndarray, "E2 T f"]],
) -> Verdict:
    """Whether every key feature is finite and varies in canonical play.

    Args:
        names: Of the features.
        canonical: Their values in canonical play.
        others: Those of other humans, to show what the features see; may be empty.
    """
    rows = np.asarray(canonical, dtype=np.float64).reshape(-1, len(names))
    finite = [bool(np.isfinite(column).all()) for column in rows.T]
    ill = [name for name, good in zip(names, finite, strict=True) if not good]
    if ill:
        return Verdict(
            "features", "fail", f"Not every value is a finite number: {listed(ill)}.",
            "Mend the task's features, or leave these out with --features.", {"names": list(names)},
        )  # fmt: skip
    std, size = rows.std(axis=0), np.abs(rows).max(axis=0)
    still = [
        name
        for name, deviation, large in zip(names, std, size, strict=True)
        if deviation <= _CONSTANT * max(1.0, large)
    ]
    evidence = {
        "names": list(names), "std": std.tolist(), "constant": still,
        "spread": {
            kind: _in_deviations(values, rows.mean(axis=0), std)
            for kind, values in {"canonical": canonical, **others}.items()
        },
    }  # fmt: skip
    if still:
        word = "is constant" if len(still) == 1 else "are constant"
        return Verdict(
            "features", "fail",
            f"{len(still)} of {len(names)} key features {word} in canonical play: {listed(still)}.",
            "Naturalness cannot come from what never moves: leave these out with --features, or "
            "mend the task that should move them.",
            evidence,
        )  # fmt: skip
    return Verdict(
        "features", "pass",
        f"All {len(names)} key features vary in canonical play and are finite.",
        "", evidence,
    )  # fmt: skip


def _in_deviations(
    values: Float[np.ndarray, "E T f"], mean: np.ndarray, std: np.ndarray
) -> list[dict[str, Any]]:
    """5 %, median and 95 % of each feature, in canonical deviations from the canonical mean."""
    unit = np.where(std > 0, std, 1.0)
    rows = (np.asarray(values, dtype=np.float64).reshape(-1, len(mean)) - mean) / unit
    low, middle, high = np.nanquantile(rows, (_BAND[0], 0.5, _BAND[1]), axis=0)
    return [
        {"low": float(a), "median": float(b), "high": float(c)}
        for a, b, c in zip(low, middle, high, strict=True)
    ]
