"""The toy run, shared with other folders. Imports stand in the fixtures, as in tests/compute."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def base(tmp_path_factory):
    """Where the toy policies lie, in `pair`, and everything that is measured once."""
    from tests.compute.tiny import store_pair

    base = tmp_path_factory.getbasetemp()
    store_pair(base / "pair")
    return base


@pytest.fixture(scope="session")
def single_run(base):
    """A measurement of the toy robot with one seed; the one of tests/compute."""
    from tests.compute.tiny import measured_once

    return measured_once(base, "single", seeds=[0])
