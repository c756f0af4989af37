"""Folders to work in."""

from __future__ import annotations

import pytest

collect_ignore = [
    "scripted.py"
]  # Needs torch, and holds no doctests; what is marked sb3 imports it.


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty working directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path
