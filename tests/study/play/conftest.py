"""Short episodes with the bundled robots."""

import pytest

from rigid.policies.loading import load_policy
from rigid.tasks.registry import make_task

HORIZON = 20


@pytest.fixture(scope="session", params=["itch-scratching", "feeding"])
def task(request):
    """Both tasks that people can play, with short episodes."""
    return make_task(request.param).with_parameters(horizon=HORIZON)


@pytest.fixture(scope="session")
def robot(task):
    return load_policy("builtin:vanilla", task=task)


@pytest.fixture(scope="session")
def itching():
    return make_task("itch-scratching").with_parameters(horizon=HORIZON)


@pytest.fixture(scope="session")
def scratcher(itching):
    return load_policy("builtin:vanilla", task=itching)
