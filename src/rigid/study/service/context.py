"""What every door needs: the study, its data, its engine, and who may do how much."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid.study.judging import Clips
from rigid.study.plan import StudyPlan
from rigid.study.service import limits
from rigid.study.service.desk import Desk
from rigid.study.service.engine import Engine
from rigid.study.service.limits import Buckets
from rigid.study.service.refusing import Refusal, Refusals
from rigid.study.store import Store

if TYPE_CHECKING:
    from rigid.study.service.live import LiveConnection

_PERIODS = 10_000
"""How many of the last periods between steps are kept: a minute of 16 participants."""


@dataclass
class Rates:
    """How much each sender has left."""

    requests: Buckets = field(default_factory=lambda: Buckets(limits.REQUESTS))
    connections: Buckets = field(default_factory=lambda: Buckets(limits.CONNECTIONS))
    messages: Buckets = field(default_factory=lambda: Buckets(limits.MESSAGES))
    targets: Buckets = field(default_factory=lambda: Buckets(limits.TARGETS))
    refused: Buckets = field(default_factory=lambda: Buckets(limits.REFUSED))
    public: Buckets = field(default_factory=lambda: Buckets(limits.PUBLIC))
    strangers: Buckets = field(default_factory=lambda: Buckets(limits.STRANGERS))


@dataclass
class Service:
    """One study that is being served."""

    plan: StudyPlan
    store: Store
    engine: Engine
    clips: Clips
    data: Path
    """Where the store lies."""
    scene: bytes
    """JSON: as in reports; null for a task without a picture."""
    texts: Mapping[str, Any]
    """The words of the page's language."""
    static: Mapping[str, bytes]
    """The front end: `study.js`, `study.css`, `page.html`."""
    address: str
    """How participants reach the server, such as http://127.0.0.1:8000; no slash at the end."""
    desk: Desk = field(default_factory=lambda: Desk("store"))
    exporting: Desk = field(default_factory=lambda: Desk("export"))
    """Exports are slow, and read beside the desk."""
    refusals: Refusals = field(default_factory=Refusals)
    rates: Rates = field(default_factory=Rates)
    live: dict[str, LiveConnection] = field(default_factory=dict)
    """Who plays, by code: one connection each."""
    sessions: set[str] = field(default_factory=set)
    """Cookies of the admin, until the server ends."""
    periods: deque[float] = field(default_factory=lambda: deque(maxlen=_PERIODS))
    """Between the beginnings of steps [s], newest last."""
    clock: Callable[[], float] = time.monotonic
    sleep: Callable[[float], Awaitable[None]] = asyncio.sleep
    """On that clock; a pilot may run faster than life."""

    def allow(self, buckets: Buckets, sender: str) -> None:
        """Takes one from what a sender may send.

        Raises:
            Refusal: Nothing is left.
        """
        if not buckets.take(sender, self.clock()):
            raise Refusal("too-many", "too many requests: wait a little and try again")

    async def keep_refusals(self) -> None:
        """Writes down what was refused since the last time.

        Raises:
            UserError: It cannot be written now; the next call tries again.
        """
        await self.refusals.keep(
            lambda reason, count: self.desk.do(self.store.count_refused, reason, count)
        )

    def close(self) -> None:
        """Ends all threads, once what they were asked for is done."""
        self.engine.close()
        self.exporting.close()
        self.desk.close()
