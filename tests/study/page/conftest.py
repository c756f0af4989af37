"""A real study in a thread, and a real browser of a participant."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from playwright.sync_api import Page

from rigid.report.build import embed_json
from rigid.study.judging import Clips, prepare_clips
from rigid.study.judging.motion import motion_text
from rigid.study.plan import (
    Completion,
    JudgeStage,
    PlayStage,
    PractiseStage,
    Role,
    StudyPlan,
    WatchStage,
)
from rigid.study.play.episode import PlayedEpisode
from rigid.study.records import PlayedRecord
from rigid.study.service.context import Service
from rigid.study.service.engine import Engine
from rigid.study.service.opening import front_end, texts_of
from rigid.study.service.running import listen, server_of
from rigid.study.store import Store
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.browser import browser
from tests.study.judging import sources
from tests.toys import untrained

__all__ = ["browser"]
STEPS, HELD = 12, 4
TASK = ItchScratching(ItchScratchingParameters(horizon=STEPS))
"""The real task at its real rate, in episodes of 1.2 s."""
IWER = Path(__file__).parents[3] / "web" / "node_modules" / "iwer" / "build" / "iwer.min.js"
SMALL = {"width": 320, "height": 360}
"""Few pixels: the browser of the tests draws without a graphics card."""


class Patient(PlayedEpisode):
    """An episode that goes on from step `HELD` only when told, however slow the browser is."""

    def __init__(self, task, robot, *, seed: int, go: threading.Event) -> None:
        super().__init__(task, robot, seed=seed)
        self._go, self._steps = go, 0

    def advance(self, target, *, age: float, at: float):
        self._steps += 1
        if self._steps > HELD:
            assert self._go.wait(timeout=120)
        return super().advance(target, age=age, at=at)


class PatientEngine(Engine):
    """Makes such episodes."""

    def __init__(self, robots) -> None:
        super().__init__(TASK, robots)
        self.robots, self.go = robots, threading.Event()

    async def step(self, work, *args, **kwargs):
        """On a thread, whatever the robot: the server goes on while an episode waits."""
        return await self.do(work, *args, **kwargs)

    def episode(self, robot: str, seed: int) -> PlayedEpisode:
        return Patient(TASK, self.robots[robot], seed=seed, go=self.go)


def questionnaires(folder: Path) -> tuple[JudgeStage, ...]:
    """All three, about one pair each; writes the pair files."""
    return tuple(
        JudgeStage(
            question=question, pairs=sources.write_pairs(folder / question, question, count=1),
            show="snapshot" if question == "correspondence" else "replay", count=1,
        )
        for question in sources.KINDS
    )  # fmt: skip


def plan(judge: tuple[JudgeStage, ...]) -> StudyPlan:
    """Novices do all that there is, once; players have two episodes to play."""
    watch, play = WatchStage(episodes=1), PlayStage(episodes=1)
    return StudyPlan(
        title="A small study", robots={"a": "builtin:vanilla"},
        roles={
            "novice": Role(participants=3, stages=(watch, PractiseStage(episodes=1), play, *judge)),
            "player": Role(participants=3, stages=(PlayStage(episodes=2),)),
        },
        completion=Completion(code="TEST-1234"),
    )  # fmt: skip


class Invited(NamedTuple):
    """A participant who has a link and nothing else yet."""

    service: Service
    code: str
    url: str

    def ready(self) -> Invited:
        """Has consented and skipped the questions."""
        self.service.store.consent(self.code, "1", sharing=False)
        self.service.store.demographics(self.code, {})
        return self

    def episodes(self) -> list[PlayedRecord]:
        return list(self.service.store.episodes(self.code))

    @contextlib.contextmanager
    def held(self) -> Iterator[None]:
        """Episodes wait for the block to end."""
        go = self.service.engine.go
        go.clear()
        try:
            yield
        finally:
            go.set()


def _motion() -> bytes:
    """An episode to watch, in which nobody does anything."""
    world = TASK.make_world(1, threads=1)
    world.reset(np.array([0]))
    states = [world.snapshot()[0]]
    for _ in range(STEPS):
        world.step(np.zeros((1, TASK.robot.action_size)), np.zeros((1, TASK.human.action_size)))
        states.append(world.snapshot()[0])
    return motion_text(TASK.replay(np.array(states)))


def _clips(study: StudyPlan, judge: tuple[JudgeStage, ...], data: Path) -> Clips:
    """One episode to watch, and the motions of the questionnaires."""
    raters = {"rater": Role(participants=1, stages=judge)}
    judged = prepare_clips(
        study.model_copy(update={"roles": raters}), data,
        task=sources.TASK, robots={"a": sources.ROBOT},
    ).judged  # fmt: skip
    return Clips(study, (_motion(),), judged)


@pytest.fixture(scope="session")
def invite(tmp_path_factory) -> Iterator:
    """Serves one study; makes participants of a role."""
    data = tmp_path_factory.mktemp("page") / "data"
    judge = questionnaires(tmp_path_factory.mktemp("pairs"))
    study = plan(judge)
    with Store.open(data, study) as store, listen("127.0.0.1", 0) as opened:
        address = f"http://127.0.0.1:{opened.getsockname()[1]}"
        robots = {"a": untrained(TASK.robot)}
        service = Service(
            plan=study, store=store, engine=PatientEngine(robots),
            clips=_clips(study, judge, data), data=data, static=front_end(),
            texts=texts_of("en"), scene=embed_json(TASK.scene()).encode(), address=address,
        )  # fmt: skip
        server = server_of(service)
        serving = server.serve(sockets=[opened])
        thread = threading.Thread(target=asyncio.run, args=(serving,), daemon=True)
        thread.start()

        def invited(role: str) -> Invited:
            invitation = store.invite(role)
            return Invited(service, invitation.code, f"{address}/p/{invitation.token}")

        try:
            yield invited
        finally:
            server.should_exit = True
            thread.join(timeout=60)
            assert not thread.is_alive(), "the server does not end"
            service.close()


def note(page: Page, text: str | bytes) -> None:
    """Remembers the hand targets that a page sent."""
    said = json.loads(text)
    if said["type"] == "target":
        page.targets.append(said["position"])


@pytest.fixture(scope="module")
def visit(browser):
    """Opens a participant's page; fails when it asked for anything elsewhere or had an error."""

    @contextlib.contextmanager
    def open_page(participant: Invited, *scripts: str, **settings) -> Iterator[Page]:
        context = browser.new_context(**{"viewport": SMALL, **settings})
        context.set_default_timeout(60_000)  # [ms]; a shared machine may pause the browser.
        for script in scripts:
            context.add_init_script(script)
        troubles: list[str] = []
        home = participant.url.split("/p/")[0]
        page = context.new_page()
        page.targets = []
        page.on("websocket", lambda ws: ws.on("framesent", lambda text: note(page, text)))
        own = re.compile(rf"{re.escape(home)}|data:|blob:|{re.escape(home.replace('http', 'ws'))}")
        page.on("request", lambda r: own.match(r.url) or troubles.append(r.url))
        page.on("console", lambda m: m.type == "error" and troubles.append(m.text))
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.goto(participant.url)
        page.wait_for_selector("body[data-screen]")
        yield page
        context.close()
        assert troubles == []

    return open_page
