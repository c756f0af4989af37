"""The toy pair that every recipe starts from. Imports stand in fixtures, as in tests/compute."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def pair(tmp_path_factory):
    """A finished pair. Copy it before changing it."""
    from tests.robots.quick import co_optimise

    return co_optimise(tmp_path_factory.mktemp("pair"))


@pytest.fixture(scope="session")
def single_run(tmp_path_factory):
    """The toy measurement of one seed of tests/compute."""
    from tests.compute.tiny import measured_once, store_pair

    base = tmp_path_factory.getbasetemp()
    store_pair(base / "pair")
    return measured_once(base, "single", seeds=[0])
