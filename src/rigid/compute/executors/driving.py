"""Keeping workers busy with the groups of many searches, wherever the workers are."""

from __future__ import annotations

from collections.abc import Generator, Hashable, Iterable, Mapping
from typing import Protocol, TypeVar, runtime_checkable

from rigid.compute.search.group_plan import GroupPlan
from rigid.compute.search.seed_search import SeedSearch

Ticket = TypeVar("Ticket", bound=Hashable)
"""What a group is known by while it is handed out."""


@runtime_checkable
class Pool(Protocol[Ticket]):
    """Workers who run one group each at a time; `waiting` are groups that are handed out."""

    @property
    def asked_for(self) -> int:
        """Groups that should be handed out at any time."""
        ...

    def send(self, search: SeedSearch, plan: GroupPlan) -> Ticket:
        """Hands out a group, and returns what it is known by."""
        ...

    def next_done(self, waiting: Mapping[Ticket, tuple[SeedSearch, GroupPlan]]) -> Ticket | None:
        """A group that is done; None when none is for a while."""
        ...

    def collect(self, done: Ticket, search: SeedSearch, plan: GroupPlan) -> None:
        """Puts the group's files where they belong, and its points into its search."""
        ...

    def cancel(self, waiting: Mapping[Ticket, tuple[SeedSearch, GroupPlan]]) -> None:
        """Takes back what is not done, at the end of an interrupted measurement."""
        ...


def drive(searches: Iterable[SeedSearch], pool: Pool[Ticket]) -> Generator[SeedSearch, None, None]:
    """Runs searches side by side, as many as keep every worker busy; see `Workers.run`."""
    source, more = iter(searches), True
    waiting: dict[Ticket, tuple[SeedSearch, GroupPlan]] = {}
    try:
        while waiting or more:
            search: SeedSearch | None
            if more and len(waiting) < pool.asked_for:
                search = next(source, None)
                more = search is not None
            else:
                search = _next_done(pool, waiting)
            if search is not None and not _send_next(pool, search, waiting):
                yield search
    finally:
        pool.cancel(waiting)


def _next_done(
    pool: Pool[Ticket], waiting: dict[Ticket, tuple[SeedSearch, GroupPlan]]
) -> SeedSearch | None:
    done = pool.next_done(waiting)
    if done is None:
        for search, _ in waiting.values():
            search.clock.tick()
        return None
    search, plan = waiting.pop(done)
    pool.collect(done, search, plan)
    return search


def _send_next(
    pool: Pool[Ticket], search: SeedSearch, waiting: dict[Ticket, tuple[SeedSearch, GroupPlan]]
) -> bool:
    """Hands out the next group of a seed; False when its search is over."""
    plan = search.next_plan()
    if plan is None:
        return False
    waiting[pool.send(search, plan)] = (search, plan)
    return True
