"""Hostile messages: each is refused, counted once, and without effect."""

import asyncio
import random
import socket

import httpx
import pytest

from benchmarks.people.attacks import ATTACKS, Attacker
from rigid.study.service.limits import MESSAGES, REFUSED, Buckets, Rate
from tests.study.service.serving import ADMIN, HTTP


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.__name__)
def test_a_hostile_message_is_refused_and_counted_once(server, attack):
    page = server.page(ready=False)
    before = sum(server.refused().values())

    async def send() -> list[bool]:
        async with httpx.AsyncClient() as client:
            port = int(server.address.rpartition(":")[2])
            attacker = Attacker(port, page.token, random.Random(0), client)  # noqa: S311 - no secrets.
            refused = [await attack(attacker) for _ in range(6)]
            await attacker.close()
            return refused

    assert asyncio.run(send()) == 6 * [True]
    assert sum(server.refused().values()) == before + 6
    assert "http:fault" not in server.refused()
    person = server.service.store.participant(page.code)
    assert (person.status, person.consent_version) == ("invited", None)


def test_nothing_that_was_sent_is_said_back(server):
    page = server.page()
    answer = page.post("calibration", {"arm_length": "<script>", "seat_height": 1.0})
    assert answer.json() == {
        "error": "invalid", "message": "arm_length: Input should be a valid number",
    }  # fmt: skip


def test_texts_that_no_table_can_hold_are_refused(server):
    page, headers = server.page(ready=False), {"Authorization": f"Bearer {ADMIN}"}
    page.post("consent", {"version": "1", "agreed": True})
    answer = page.post("demographics", {"gender_description": "a\0b"})
    assert (answer.status_code, answer.json()["error"]) == (400, "invalid")
    said = {"role": "watcher", "external_id": "a\0b"}
    answer = HTTP.post(f"{server.address}/admin/api/invite", json=said, headers=headers)
    assert (answer.status_code, answer.json()["error"]) == (400, "invalid")


def test_a_page_that_asks_too_often_is_told_to_wait_and_nobody_else(server, monkeypatch):
    page, other = server.page("watcher"), server.page("watcher")
    monkeypatch.setattr(server.service.rates, "requests", Buckets(Rate(3, 0)))
    codes = [page.get("state").status_code for _ in range(5)]
    assert codes == [200, 200, 200, 429, 429]
    assert other.get("state").status_code == 200


def test_strangers_use_up_nothing_of_who_has_a_link_at_the_same_address(server, monkeypatch):
    page = server.page("watcher")
    monkeypatch.setattr(server.service.rates, "strangers", Buckets(Rate(2, 0)))
    codes = [HTTP.get(f"{server.address}/p/{'x' * 32}").status_code for _ in range(4)]
    assert codes == [401, 401, 429, 429]
    assert HTTP.get(f"{server.address}/admin/").status_code == 429
    headers = {"Authorization": f"Bearer {ADMIN}"}
    assert HTTP.get(f"{server.address}/admin/", headers=headers).status_code == 200
    assert page.get("state").status_code == 200


def test_a_flood_of_live_messages_closes_with_4429(server):
    with server.page().live() as live:
        for _ in range(2 * MESSAGES.burst):
            live.say(type="ping", sent=0.0)
        assert live.closed() == 4429


def test_refused_live_messages_close_with_4429_in_the_end(server):
    with server.page().live() as live:
        for _ in range(REFUSED.burst + 20):
            live.say(type="nonsense")
        assert live.closed() == 4429


def test_more_targets_than_thirty_a_second_have_no_effect(server):
    with server.page().live() as live:
        for _ in range(60):
            live.aim((0.1, 0.2, 0.3))
        assert live.hear() == {"type": "refused", "reason": "too-many"}
        live.start()  # Nor do they harm: what is heard next is no refusal for long.
        while live.hear()["type"] == "refused":
            pass


def test_a_replayed_number_is_refused_and_the_next_one_taken(server):
    with server.page().live() as live, server.counting("live:replayed"):
        live.say(type="ping", sent=1.0, n=7)
        live.say(type="ping", sent=2.0, n=7)
        live.say(type="ping", sent=3.0, n=8)
        heard = [live.hear() for _ in range(3)]
    assert heard == [
        {"type": "pong", "sent": 1.0}, {"type": "refused", "reason": "replayed"},
        {"type": "pong", "sent": 3.0},
    ]  # fmt: skip


def test_a_request_that_never_ends_is_given_up(server, monkeypatch):
    monkeypatch.setattr("rigid.study.service.protocols.HEADER_SECONDS", 0.05)
    port = int(server.address.rpartition(":")[2])
    with (
        server.counting("wire:too-slow"),
        socket.create_connection(("127.0.0.1", port), timeout=5) as opened,
    ):
        opened.sendall(b"GET / HTTP/1.1\r\nHost:")
        assert opened.recv(100) == b""


def test_a_body_that_never_ends_is_given_up(server, monkeypatch):
    monkeypatch.setattr("rigid.study.service.requests.BODY_SECONDS", 0.05)
    page = server.page()
    port = int(server.address.rpartition(":")[2])
    with (
        server.counting("http:too-slow"),
        socket.create_connection(("127.0.0.1", port), timeout=5) as opened,
    ):
        head = f"POST /p/{page.token}/api/stop HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n"
        opened.sendall(f"{head}Content-Type: application/json\r\n\r\n".encode() + b"{")
        assert opened.recv(100).startswith(b"HTTP/1.1 408")


def test_an_address_has_so_many_connections_at_a_time(server, monkeypatch):
    page = server.page()
    port = int(server.address.rpartition(":")[2])
    monkeypatch.setattr("rigid.study.service.protocols.CONNECTED", 2)
    with (
        server.counting("wire:too-many"),
        page.live(),
        socket.create_connection(("127.0.0.1", port), timeout=5),
        socket.create_connection(("127.0.0.1", port), timeout=5) as third,
    ):
        assert ends(third)
    # Those that ended count no more, WebSockets as well as others.
    with page.live(), socket.create_connection(("127.0.0.1", port), timeout=5) as second:
        second.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
        assert second.recv(100).startswith(b"HTTP/1.1 200")


def ends(opened: socket.socket) -> bool:
    """Whether the other side closes without a word."""
    try:
        return opened.recv(100) == b""
    except ConnectionResetError:
        return True


def test_what_headers_say_of_the_address_is_not_believed(server):
    page = server.page()
    said = {
        "X-Forwarded-For": "10.0.0.1",
        "X-Forwarded-Host": "evil.example",
        "Host": "evil.example",
    }
    answer = HTTP.get(f"{page.url}/api/state", headers=said)
    assert answer.status_code == 200
    assert "evil" not in answer.text
