"""Counts of what was refused outlive a database that is busy for a while."""

import asyncio
import sqlite3
import time
from contextlib import contextmanager

import pytest

from rigid.study.service import app
from rigid.study.service.refusing import Refusals
from rigid.study.store import Store
from tests.study.service.serving import ADMIN, HTTP, served


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


def test_two_who_write_counts_down_at_once_write_each_once():
    """As the server does by itself, and whenever the admin's page asks."""
    refusals, found = Refusals(), []

    async def write(reason, count):
        await asyncio.sleep(0)
        found.append((reason, count))

    async def both():
        await asyncio.gather(refusals.keep(write), refusals.keep(write))

    for reason in ("not-found", "too-many"):
        refusals.count("http", reason)
    asyncio.run(both())
    assert sorted(found) == [("http:not-found", 1), ("http:too-many", 1)]


def test_progress_is_shown_while_the_database_is_busy(server, data):
    HTTP.get(f"{server.address}/nowhere")
    wait_for(lambda: written(data) == {"http:not-found": 1})
    with busy(server):
        HTTP.get(f"{server.address}/nowhere")
        headers = {"Authorization": f"Bearer {ADMIN}"}
        answer = HTTP.get(f"{server.address}/admin/api/progress", headers=headers)
    assert (answer.status_code, answer.json()["title"]) == (200, "A <small> study")
