"""Study files. Imports stand in the fixture, as in tests/compute."""

from __future__ import annotations

import pytest


@pytest.fixture
def parsed(tmp_path):
    """Reads the text of a study file."""
    from rigid.study.plan_file import parse_plan

    return lambda text: parse_plan(text, where="s.yaml", folder=tmp_path)
