"""Every test of this folder runs with each assistive task."""

import pytest

from tests.tasks.assistive.cases import CASES


@pytest.fixture(scope="session", params=CASES, ids=[case.name for case in CASES])
def case(request):
    """One task, and what tests have to know of it."""
    return request.param


@pytest.fixture(scope="session")
def task(case, request):
    """The compiled task, with the reference person."""
    return request.getfixturevalue(case.folder)
