"""Live play over real WebSockets, on real physics."""

import socket
import time
from contextlib import contextmanager

import numpy as np
import pytest

from rigid.study.play.episode import FAULTED, PlayedEpisode
from rigid.study.play.frame import Frame
from tests.study.service.serving import STEPS, TASK, Leaner


def stored(server, page):
    return list(server.service.store.episodes(page.code))


def attempts(server, page):
    """How often the first episode was begun; asking counts as another time."""
    return server.service.store.begin_attempt(page.code, "play", 0) - 1


def test_an_episode_is_announced_with_all_that_the_page_needs(server):
    with server.page().live() as live:
        announced, *_ = live.episode()
    assert announced["type"] == "episode"
    assert {"kind", "number", "of", "bodies", "substeps", "period", "goal", "reach", "horizon",
            "hand"} <= set(announced)  # fmt: skip
    assert (announced["kind"], announced["number"], announced["of"]) == ("play", 0, 50)


def test_an_episode_shows_its_start_and_each_step(server):
    with server.page().live() as live:
        _, frames, _ = live.episode()
    assert [frame.step for frame in frames] == list(range(STEPS + 1))
    assert [frame.done for frame in frames] == STEPS * [False] + [True]


def test_an_acknowledged_episode_is_in_the_store(server):
    page = server.page()
    with page.live() as live:
        announced, _, finished = live.episode()
        (record,) = stored(server, page)
    assert finished == {"type": "finished", "number": 0, "success": False, "done": 1, "of": 50}
    assert (record.number, record.kind, record.device, record.attempts) == (0, "play", "mouse", 1)
    assert announced["number"] == record.number


def test_what_is_stored_is_what_the_server_simulated(server):
    page = server.page()
    with page.live() as live:
        _, frames, _ = live.episode()
    (record,) = stored(server, page)
    again = PlayedEpisode(TASK, Leaner(), seed=record.seed)
    again.begin()
    for target in record.arrays.targets:
        frame = again.advance(target, age=0.0, at=0.0)
    assert np.array_equal(again.finish().arrays.states, record.arrays.states)
    assert np.allclose(frame.poses, frames[-1].poses, atol=1e-4)


def test_before_the_first_target_the_hand_stays_where_it_is(server):
    page = server.page()
    with page.live() as live:
        announced, *_ = live.episode()
    (record,) = stored(server, page)
    assert np.isinf(record.arrays.target_age).all()
    assert np.allclose(record.arrays.targets, announced["hand"])


def test_the_newest_target_is_what_is_played(server):
    page = server.page()
    with page.live() as live:
        live.start()
        hand = np.array(live.hear()["hand"])
        aims = [(hand + [0, 0, height]).tolist() for height in (0.02, 0.05)]
        for aim in aims:
            live.aim(aim)
        assert live.hear_text()["type"] == "finished"
    (record,) = stored(server, page)
    assert np.allclose(record.arrays.targets[-1], aims[-1])
    assert np.isfinite(record.arrays.target_age[-1])


def test_steps_follow_the_servers_clock(server):
    page = server.page()
    with page.live() as live:
        live.episode()
    (record,) = stored(server, page)
    # Never early; how late is up to the machine.
    assert (record.arrays.step_times >= TASK.control_period * np.arange(STEPS) - 1e-6).all()


def test_the_next_episode_has_the_next_number_and_another_start(server):
    page = server.page()
    with page.live() as live:
        for number in range(2):
            announced, *_ = live.episode()
            assert announced["number"] == number
    first, second = stored(server, page)
    assert first.seed != second.seed


def test_a_dropped_connection_begins_the_same_episode_anew(lasting):
    page = lasting.page()
    for _ in range(2):
        with page.live() as live:
            live.start()
            assert live.hear()["number"] == 0
    assert attempts(lasting, page) == 2


def test_a_second_window_closes_the_first(server):
    page = server.page()
    with page.live() as first, page.live() as second:
        assert first.closed() == 4409
        assert second.episode()[2]["type"] == "finished"


def test_a_second_window_ends_the_episode_of_the_first(lasting):
    page = lasting.page()
    with page.live() as first:
        first.start()
        first.hear()
        with page.live() as second:
            second.start()
            assert second.hear()["number"] == 0
    assert attempts(lasting, page) == 2


@contextmanager
def deaf(page):
    """A window that begins an episode, and then neither reads nor says anything."""
    port = int(page.address.rpartition(":")[2])
    with socket.socket() as raw:
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)  # The smallest that there is.
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_MAXSEG, 536)
        raw.connect(("127.0.0.1", port))
        raw.sendall(
            f"GET /p/{page.token}/live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
            "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
            "Sec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        while not raw.recv(1024).endswith(b"\r\n\r\n"):
            pass
        said = b'{"type":"start","n":1,"device":"mouse"}'
        raw.sendall(bytes([0x81, 0x80 | len(said)]) + bytes(4) + said)  # Masked with zeros.
        yield raw


def given_up(server, page):
    """Waits until the server has found out that a page takes nothing."""
    deadline = time.monotonic() + 60
    while (
        (one := server.service.live.get(page.code)) is None
        or one._playing is None
        or not one._playing.done()
    ):
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.fixture
def few_bytes(monkeypatch):
    """Nothing waits for who does not read, so that they are found out at once."""
    monkeypatch.setattr("rigid.study.service.protocols.UNREAD_BYTES", 1)
    monkeypatch.setattr("rigid.study.service.live.SEND_SECONDS", 0.1)


@pytest.mark.usefixtures("few_bytes")
def test_a_second_window_need_not_wait_for_a_first_that_is_out_of_reach(lasting):
    page = lasting.page()
    with deaf(page):
        given_up(lasting, page)
        with page.live() as second:
            second.start()
            assert second.hear()["number"] == 0
    assert attempts(lasting, page) == 2


def test_an_unknown_token_is_closed_with_4401(server):
    page = server.page()
    page.url = f"{server.address}/p/{'x' * 32}"
    with server.counting("live:unknown-token"), page.live() as live:
        assert live.closed() == 4401


def test_a_halt_ends_the_episode_and_stores_nothing(lasting):
    page = lasting.page()
    with page.live() as live:
        live.start()
        live.hear()
        live.say(type="stop")
        assert live.hear_text() == {"type": "stopped"}
    assert not stored(lasting, page)


def test_a_ping_is_answered_with_what_it_said(server):
    with server.page().live() as live:
        live.say(type="ping", sent=12.5)
        assert live.hear() == {"type": "pong", "sent": 12.5}


def test_nothing_is_played_before_consent(server):
    with server.page(ready=False).live() as live, server.counting("live:not-now"):
        live.start()
        assert live.hear() == {"type": "refused", "reason": "not-now"}


def test_only_one_episode_runs_at_a_time(lasting):
    with lasting.page().live() as live, lasting.counting("live:not-now"):
        live.start()
        live.hear()
        live.start()
        assert live.hear_text() == {"type": "refused", "reason": "not-now"}


def test_stopping_ends_what_is_played_and_stores_nothing_of_it(lasting):
    page = lasting.page()
    with page.live() as live:
        live.start()
        live.hear()
        assert page.post("stop", {}).json()["stage"] == {"kind": "stopped"}
        assert live.closed() == 1000
    assert not stored(lasting, page)


def test_withdrawing_while_playing_leaves_nothing(lasting):
    page = lasting.page()
    with page.live() as live:
        live.start()
        live.hear()
        state = page.post("withdraw", {"confirm": "withdraw"}).json()
    assert state["stage"] == {"kind": "withdrawn"}
    assert page.code in lasting.service.store.withdrawn()
    assert not stored(lasting, page)
    assert page.get("state").status_code == 401


def test_frames_come_as_bytes_of_the_bodies_that_were_named(server):
    with server.page().live() as live:
        announced, frames, _ = live.episode()
    assert all(isinstance(frame, Frame) for frame in frames)
    assert {frame.poses.shape[1] for frame in frames} == {len(announced["bodies"])}
    assert frames[1].poses.shape[0] == announced["substeps"]


def running_away(task, robot, seed):
    """An episode whose physics runs away in its second step."""
    episode = PlayedEpisode(task, robot, seed=seed)
    step = episode._world.step

    def shaken(*actions):
        if len(episode._rows) == 1:
            episode._world._batch.bind("qvel")[0, 12] = 1e12
        return step(*actions)

    episode._world.step = shaken
    return episode


def test_an_episode_that_runs_away_is_stored_as_such_and_the_next_one_follows(server, monkeypatch):
    page, engine = server.page(), server.service.engine
    with page.live() as live:
        with monkeypatch.context() as patched:
            patched.setattr(engine, "episode", lambda _, seed: running_away(TASK, Leaner(), seed))
            _, frames, finished = live.episode()
        assert frames[-1].done
        assert finished == {"type": "finished", "number": 0, "success": None, "done": 1, "of": 50}
        assert live.episode()[0]["number"] == 1
    first, second = stored(server, page)
    assert (first.outcome, len(first.arrays.rewards)) == (FAULTED, 2)
    assert np.isnan([first.episode_return, first.success]).all()
    assert second.outcome != FAULTED
    assert page.stage()["done"] == 2
