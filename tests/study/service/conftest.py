import pytest

from tests.study.service.serving import TASK, served


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    with served(tmp_path_factory.mktemp("served") / "data") as found:
        yield found


@pytest.fixture(scope="session")
def lasting(tmp_path_factory):
    """A server whose episodes last a minute, so that they end only when they are ended."""
    task = TASK.with_parameters(horizon=3000)
    with served(tmp_path_factory.mktemp("lasting") / "data", task=task) as found:
        yield found
