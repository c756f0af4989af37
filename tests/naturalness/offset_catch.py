"""Offset catch, a one-step task with closed forms: canonical offsets N(0, 1), adversary N(m, 1)."""

from __future__ import annotations

import numpy as np
from scipy.stats import norm


def offsets(shift, count, seed):
    """`count` rows of one feature from N(`shift`, 1)."""
    return np.random.default_rng(seed).normal(shift, 1.0, (count, 1)).astype(np.float32)


def log_ratio(x, shift):
    """log q/p of a row."""
    return shift * x - shift**2 / 2


def best_score(x, shift, kappa):
    """(r - κ) / (r + κ) with r = q/p."""
    return np.tanh((log_ratio(x, shift) - np.log(kappa)) / 2)


def boundary(shift, kappa):
    """Where q = κ p."""
    return shift / 2 + np.log(kappa) / shift


def overlap(shift, kappa):
    """∫ min(q, κ p)."""
    edge = boundary(shift, kappa)
    return norm.cdf(edge - shift) + kappa * norm.sf(edge)
