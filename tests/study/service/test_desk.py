"""What a desk was asked for is done, whoever stops waiting."""

from __future__ import annotations

import asyncio
import threading

import pytest

from rigid.study.service.desk import Desk


@pytest.fixture
def desk():
    desk = Desk("desk")
    yield desk
    desk.close()


def test_work_is_done_in_order_and_to_its_end_though_nobody_waits_for_it_any_more(desk):
    """Whether it was under way or waited for its turn."""
    free, done = threading.Event(), []

    def work(name: str) -> None:
        free.wait(30)
        done.append(name)

    async def ask_and_leave() -> None:
        asked = [asyncio.create_task(desk.do(work, name)) for name in ("first", "second")]
        await asyncio.sleep(0)  # Both have asked.
        for one in asked:
            one.cancel()
        await asyncio.gather(*asked, return_exceptions=True)
        free.set()

    asyncio.run(ask_and_leave())
    desk.close()
    assert done == ["first", "second"]


def test_what_work_returns_or_raises_comes_back(desk):
    assert asyncio.run(desk.do(int, "7")) == 7
    with pytest.raises(ValueError, match="invalid literal"):
        asyncio.run(desk.do(int, "seven"))
