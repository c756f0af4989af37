"""Counts of what was refused outlive a database that is busy for a while."""

import sqlite3
import time
from contextlib import contextmanager

import pytest

from rigid.study.service import app
from rigid.study.store import Store
from tests.study.service.serving import HTTP, served


@pytest.fixture
def data(tmp_path):
    return tmp_path / "data"


@pytest.fixture
def server(data, monkeypatch):
    """One that writes counts down soon, and gives up soon where it cannot."""
    monkeypatch.setattr(app, "KEEP_SECONDS", 0.02)
    with served(data) as found:
        found.service.store._db.execute("PRAGMA busy_timeout=20")
        yield found


@contextmanager
def busy(server):
    """Somebody else is in the middle of a transaction."""
    db = sqlite3.connect(server.service.store.path, isolation_level=None)
    db.execute("BEGIN IMMEDIATE")
    yield
    db.execute("ROLLBACK")
    db.close()


def wait_for(condition):
    deadline = time.monotonic() + 20
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert condition()


def written(data):
    with Store.read(data) as store:
        return store.progress().refused


def test_counts_wait_while_the_database_is_busy_and_are_written_once(server, data, caplog):
    with busy(server):
        for _ in range(3):
            HTTP.get(f"{server.address}/nowhere")
        wait_for(lambda: "counts of refusals wait to be written" in caplog.text)
        assert written(data) == {}
    wait_for(lambda: written(data) == {"http:not-found": 3})
    HTTP.get(f"{server.address}/nowhere")
    wait_for(lambda: written(data) == {"http:not-found": 4})
    assert caplog.text.count("wait to be written") == 1


def test_a_server_ends_well_beside_a_busy_database(data, caplog):
    with served(data) as server:
        server.service.store._db.execute("PRAGMA busy_timeout=20")
        HTTP.get(f"{server.address}/nowhere")
        other = busy(server)
        other.__enter__()
    other.__exit__(None, None, None)
    assert "the last counts of refusals are lost" in caplog.text
    assert "Traceback" not in caplog.text
