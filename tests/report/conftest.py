"""A browser that can open nothing but files, and pages of the made-up payload."""

from __future__ import annotations

import contextlib
import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page

from rigid.report import build_report
from tests.browser import browser

__all__ = ["browser"]

HERE = Path(__file__).parent


@pytest.fixture(scope="session")
def sample_payload():
    """The maker of made-up payloads."""
    sys.path.insert(0, str(HERE))
    try:
        return importlib.import_module("sample_payload").sample_payload
    finally:
        sys.path.remove(str(HERE))


@pytest.fixture(scope="session")
def payload(sample_payload):
    """Two seeds, motions for the two worst natural points. Copy it before changing it."""
    return sample_payload(seeds=2, replays=2)


@pytest.fixture(scope="session")
def report(payload, tmp_path_factory) -> Path:
    return build_report(payload, tmp_path_factory.mktemp("report") / "report.html")


@pytest.fixture(scope="session")
def struck_task():
    """Itch scratching in episodes as short as that of `struck`."""
    from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
    from rigid.tasks.itch_scratching.task import ItchScratching
    from tests.report.struck import FRAMES

    return ItchScratching(ItchScratchingParameters(horizon=FRAMES - 1))


@pytest.fixture(scope="session")
def struck(struck_task):
    """Scene and episode of real physics; the robot strikes the person's chest at its end."""
    from tests.report.struck import struck

    return struck(struck_task)


@pytest.fixture(scope="module")
def visit(browser):
    """Opens a page, and fails when it asked for anything but itself or reported an error."""

    @contextlib.contextmanager
    def open_page(path: Path, **settings) -> Iterator[Page]:
        context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **settings})
        context.set_default_timeout(120_000)  # [ms]; a shared machine may pause the browser.
        troubles: list[str] = []

        def guard(route):
            url = route.request.url
            if url.split("#")[0] == path.as_uri():
                route.continue_()
            else:
                troubles.append(f"request: {url}")
                route.abort()

        context.route("**/*", guard)
        page = context.new_page()
        page.on("request", lambda r: r.url.startswith(("file:", "blob:")) or troubles.append(r.url))
        page.on("console", lambda m: m.type == "error" and troubles.append(m.text))
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.goto(path.as_uri())
        page.wait_for_selector(".page")
        yield page
        context.close()
        assert troubles == []

    return open_page


@pytest.fixture(scope="module")
def page(visit, report) -> Iterator[Page]:
    """One page for the tests that leave it usable for the next."""
    with visit(report) as opened:
        yield opened
