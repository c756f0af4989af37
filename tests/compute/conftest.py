"""Measurements of the toy task, each made once however many tests look at it.

Imports stand in the fixtures: pytest reads this file before jaxtyping can watch the package.
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from functools import partial

import pytest


@pytest.fixture(scope="session")
def base(tmp_path_factory):
    """Where the toy policies lie, in `pair`, and everything that is measured once."""
    from tests.compute.tiny import store_pair

    base = tmp_path_factory.getbasetemp()
    store_pair(base / "pair")
    return base


@pytest.fixture(scope="session")
def site(base):
    """Where the toy task is installed."""
    from tests.compute.tiny import install_toy

    return install_toy(base)


@pytest.fixture(scope="session")
def measure(base):
    """Measures the toy robot: `measure(out, **options)`."""
    from tests.compute.tiny import measure_tiny

    return partial(measure_tiny, base)


@pytest.fixture(scope="session")
def small_run(base):
    """A measurement with two seeds, and its report. Copy it before changing it."""
    from tests.compute.tiny import measured_once

    return measured_once(base, "small")


@pytest.fixture(scope="session")
def single_run(base):
    """The first seed of `small_run` alone. Copy it before changing it."""
    from tests.compute.tiny import measured_once

    return measured_once(base, "single", seeds=[0])


@pytest.fixture
def single_copy(single_run, tmp_path):
    """A copy of `single_run`, to be broken."""
    return shutil.copytree(single_run.directory, tmp_path / "copy")


@pytest.fixture
def hasty_referees(monkeypatch):
    """Referees of a few gradient steps, for tests that ask nothing of their verdicts."""
    from rigid.naturalness.referee import RefereeSettings

    members = RefereeSettings.members

    def hasty(self, length):
        return tuple(
            member._replace(recipe=replace(member.recipe, block=2, blocks=1))
            for member in members(self, length)
        )

    monkeypatch.setattr(RefereeSettings, "members", hasty)
