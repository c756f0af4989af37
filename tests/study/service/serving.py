"""A real server in a thread, and what a browser would do with it."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import httpx
import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from rigid.study.judging import Clips
from rigid.study.plan import PlayStage, PractiseStage, Role, StudyPlan, WatchStage
from rigid.study.play.frame import Frame, read_frame
from rigid.study.service.context import Service
from rigid.study.service.engine import Engine
from rigid.study.service.running import listen, server_of
from rigid.study.store import Store
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import ItchScratching

ADMIN = "admin-token-of-the-tests"
STEPS = 4
TASK = ItchScratching(ItchScratchingParameters(horizon=STEPS, substeps=1))
"""Real physics at 50 Hz: an episode takes 80 ms."""
CLIPS = (b'{"clip": 0}', b'{"clip": 1}')
HTTP = httpx.Client(
    transport=httpx.HTTPTransport(verify=False, limits=httpx.Limits(max_keepalive_connections=0)),
    timeout=30,
)
"""Reading certificates, which are not needed here, would take most of the time of a request."""
FRONT_END = {"study.js": b"// script", "study.css": b"/* style */", "page.html": b"<!doctype html>"}


class Leaner:
    """A robot that moves by what it sees, without a network."""

    observation_size, action_size = TASK.robot.observation_size, TASK.robot.action_size

    def initial_state(self, batch):
        del batch
        return ()

    def act(self, observation, state, rng):
        del rng
        return np.tanh(observation[:, : self.action_size]), state


def small_plan(**changes) -> StudyPlan:
    """Novices who watch two episodes, practise one and play two; watchers only watch."""
    watch = WatchStage(episodes=2)
    stages = (watch, PractiseStage(episodes=1), PlayStage(episodes=2))
    roles = {
        "novice": Role(participants=3, stages=stages),
        "watcher": Role(participants=1, stages=(watch,)),
        "player": Role(participants=1, stages=(PlayStage(episodes=50),)),
    }
    fields = {"title": "A <small> study", "robots": {"a": "builtin:vanilla"}, "roles": roles}
    return StudyPlan(**fields | changes)


class Served:
    """A study that is being served."""

    def __init__(self, service: Service, address: str):
        self.service, self.address = service, address

    def page(self, role: str = "player", *, ready: bool = True, **invited) -> Page:
        """The page of a new participant, who has consented if they are `ready`."""
        invitation = self.service.store.invite(role, **invited)
        page = Page(self.address, invitation.code, invitation.token)
        if ready:
            page.post("consent", {"version": "1", "agreed": True, "sharing": False})
            page.post("demographics", {})
        return page

    def refused(self) -> dict[str, int]:
        """Counts by door and reason."""
        return self.service.refusals.by_reason()

    @contextmanager
    def counting(self, reason: str, times: int = 1) -> Iterator[None]:
        """Asserts that something is refused, so often, for this reason alone."""
        before = self.refused()
        yield
        deadline = time.monotonic() + 5
        while True:
            new = {k: v - before.get(k, 0) for k, v in self.refused().items()}
            found = {reason: count for reason, count in new.items() if count}
            if found == {reason: times} or time.monotonic() > deadline:
                break
            time.sleep(0.01)
        assert found == {reason: times}


class Page:
    """A participant's browser."""

    def __init__(self, address: str, code: str, token: str):
        self.address, self.code, self.token = address, code, token
        self.url = f"{address}/p/{token}"

    def get(self, what: str) -> httpx.Response:
        return HTTP.get(f"{self.url}/api/{what}")

    def post(self, what: str, said: object) -> httpx.Response:
        return HTTP.post(f"{self.url}/api/{what}", json=said)

    def post_raw(self, what: str, body: bytes, kind: str = "application/json") -> httpx.Response:
        return HTTP.post(f"{self.url}/api/{what}", content=body, headers={"Content-Type": kind})

    def stage(self) -> dict:
        return self.get("state").json()["stage"]

    def watch(self, stage: int = 0, count: int = 2) -> None:
        for number in range(count):
            assert self.post("watched", {"stage": stage, "episode": f"c{number}"}).is_success

    @contextmanager
    def live(self) -> Iterator[Live]:
        with connect(f"{self.url.replace('http', 'ws', 1)}/live", compression=None) as socket:
            yield Live(socket)


class Live:
    """A participant's WebSocket."""

    def __init__(self, socket: ClientConnection):
        self.socket, self.n = socket, 0

    def say(self, **message) -> None:
        """With the next `n`, unless one is given."""
        self.n += 1
        self.socket.send(json.dumps({"n": self.n, **message}))

    def start(self, **changes) -> None:
        self.say(**{"type": "start", "device": "mouse", **changes})

    def aim(self, position: Sequence[float], **changes) -> None:
        self.say(**{"type": "target", "step": 0, "position": position, **changes})

    def hear(self) -> dict | Frame:
        """The next message."""
        found = self.socket.recv(timeout=5)
        return read_frame(found) if isinstance(found, bytes) else json.loads(found)

    def hear_text(self) -> dict:
        """The next message that is no frame."""
        while isinstance(found := self.hear(), Frame):
            pass
        return found

    def closed(self) -> int:
        """The code with which the connection is closed, after whatever else is said."""
        try:
            while True:
                self.socket.recv(timeout=5)
        except ConnectionClosed as closed:
            return closed.rcvd.code

    def episode(self) -> tuple[dict, list[Frame], dict]:
        """Plays one: how it was announced, its frames, and how it was acknowledged."""
        self.start()
        announced, frames = self.hear(), []
        while isinstance(found := self.hear(), Frame):
            frames.append(found)
        return announced, frames, found


@contextmanager
def served(
    data: Path, plan: StudyPlan | None = None, task: ItchScratching = TASK
) -> Iterator[Served]:
    """Serves a study on a free port of this machine."""
    plan = plan or small_plan()
    with Store.open(data, plan) as store, listen("127.0.0.1", 0) as opened:
        store.set_admin_token(ADMIN)
        address = f"http://127.0.0.1:{opened.getsockname()[1]}"
        robots = {key: Leaner() for key in plan.robots}
        service = Service(
            plan=plan, store=store, engine=Engine(task, robots), clips=Clips(plan, CLIPS, {}),
            data=data, scene=b'{"bodies": []}', texts={"consent": {}}, static=FRONT_END,
            address=address,
        )  # fmt: skip
        server = server_of(service)
        serving = server.serve(sockets=[opened])
        thread = threading.Thread(target=asyncio.run, args=(serving,), daemon=True)
        thread.start()
        try:
            yield Served(service, address)
        finally:
            server.should_exit = True
            thread.join(timeout=60)
            assert not thread.is_alive(), "the server does not end"
            service.close()
