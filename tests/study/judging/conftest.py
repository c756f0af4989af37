"""Pair files that are written once."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def pair_files(tmp_path_factory):
    """Twelve pairs for each question, by question. Copy a folder before changing it."""
    from tests.study.judging.sources import KINDS, write_pairs

    return {
        question: write_pairs(tmp_path_factory.mktemp("pairs"), question, count=12)
        for question in KINDS
    }
