"""What participants do on their page."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from playwright.sync_api import Page

from rigid.study.records import PlayedRecord
from tests.study.page.conftest import TASK

MAIN = "main button.primary:enabled"


def on_screen(page: Page, name: str) -> None:
    """Waits until a screen is there."""
    page.wait_for_selector(f"body[data-screen={name}]")


def card(page: Page, heading: str) -> None:
    """Waits for a card of this heading with something to press."""
    page.wait_for_function(
        """heading => document.querySelector('.card-heading')?.textContent === heading
            && document.querySelector('.play-card button')""",
        arg=heading,
    )


def running(page: Page) -> None:
    """Waits until an episode runs."""
    page.wait_for_selector(".hud.top[data-running=true]")


def until(page: Page, met: Callable[[], bool]) -> None:
    """Lets the browser go on until something is so."""
    deadline = time.monotonic() + 60
    while not met():
        assert time.monotonic() < deadline
        page.wait_for_timeout(30)


def travelled(page: Page, metres: float) -> None:
    """Waits until a target that the page sent is so far from the first one."""
    until(
        page, lambda: any(np.linalg.norm(np.subtract(at, page.targets[0])) > metres
                          for at in page.targets)
    )  # fmt: skip


def act(page: Page, action: str) -> None:
    """Presses one of the card's buttons."""
    page.click(f"[data-action={action}]")


def begin_practice(page: Page, way: str) -> None:
    """Reads what is said before the first practice, chooses how to move, and starts."""
    card(page, "Practice 1 of 1")
    act(page, "next")
    act(page, way)
    act(page, "next")
    act(page, "start")


def on_question(page: Page) -> None:
    """Waits until a pair of motions and what is asked of it are there."""
    page.wait_for_selector(".judge form")


def moved(record: PlayedRecord) -> float:
    """How far the hand target went from where it began, at most [m]."""
    targets = record.arrays.targets
    return float(np.linalg.norm(targets - targets[0], axis=1).max())


def replayed(record: PlayedRecord) -> np.ndarray:
    """The states of an episode, made anew from its seed and its actions alone."""
    world = TASK.make_world(1, threads=1)
    world.reset(np.array([record.seed]))
    states = [world.snapshot()[0]]
    for robot, human in zip(record.arrays.robot_actions, record.arrays.human_actions, strict=True):
        world.step(robot[None], human[None])
        states.append(world.snapshot()[0])
    return np.array(states)
