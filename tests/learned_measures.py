"""The search measures that tests are run for, those that compile for long only when asked."""

from __future__ import annotations

import pytest

WITH_SLOW = (
    "lsgan", "kl", "mmd",
    pytest.param("temporal", marks=pytest.mark.slow),
    pytest.param("ensemble", marks=pytest.mark.slow),
)  # fmt: skip
"""A recurrent network, and five measures at once."""
