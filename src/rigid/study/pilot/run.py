"""A pilot from the invitations to the checks."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rigid.errors import UserError
from rigid.study.flow import stage_size
from rigid.study.pilot.checking import Found, check_participant
from rigid.study.pilot.page import Page, asked
from rigid.study.pilot.scripted import Scripted
from rigid.study.pilot.server import Running, pilot_server
from rigid.study.plan import StudyPlan, load_plan
from rigid.study.players import open_players
from rigid.study.store import Store
from rigid.study.store.schema import refuse_study
from rigid.tasks.protocol import Task, control_period


@dataclass(frozen=True, kw_only=True)
class PilotOrder:
    """What a pilot is."""

    study: str
    """File, or builtin:NAME."""
    data: Path
    scripts: Sequence[str]
    """Taken in turn by those who play."""
    participants: int | None = None
    """Of each role; None: as many as are planned."""
    speed: float = 1.0
    trust: bool = False


class Ahead(NamedTuple):
    """What a pilot is about to do."""

    people: int
    things: int
    """Episodes to watch and to play, trials to answer."""
    seconds: float
    """How long it takes who has most to play [s]."""


Begin = Callable[[Ahead], Callable[[], None]]
"""Told what is ahead, before it begins; gives what is called for each thing done."""


def run_pilot(order: PilotOrder, begin: Begin) -> tuple[Found, ...]:
    """Plays a study through, and looks at what it left.

    Raises:
        UserError: The study cannot be served, or the directory holds a study already.
    """
    refuse_study(order.data)  # Its server looks again; this says it sooner.
    plan = load_plan(order.study)
    players = open_players(plan, trust=order.trust)
    tick = begin(_ahead(plan, players.task, order))
    serving = pilot_server(order.study, order.data, speed=order.speed, trust=order.trust)
    with serving as server, Store.read(order.data) as store:
        people = [
            Scripted(
                code=code, role=role, script=order.scripts[number % len(order.scripts)],
                page=Page(server.address, path), plan=plan, players=players, store=store,
                tick=tick, rng=np.random.default_rng([plan.seed, number]),
            )
            for number, (code, role, path) in enumerate(
                who
                for role in plan.roles
                for who in invite(server, role, _count(plan, role, order))
            )
        ]  # fmt: skip
        failures = asyncio.run(_all(people))
    with Store.read(order.data) as store:
        return tuple(
            check_participant(plan, players, store, who.code, failures[who.code]) for who in people
        )


async def _all(people: Sequence[Scripted]) -> Mapping[str, str | None]:
    """Everybody at once; what ended each, if anything did."""

    async def one(who: Scripted) -> str | None:
        try:
            await who.take_part()
        except UserError as error:
            return str(error)
        return None

    told = await asyncio.gather(*(one(who) for who in people))
    return {who.code: failure for who, failure in zip(people, told, strict=True)}


class Invited(NamedTuple):
    """A scripted participant."""

    code: str
    role: str
    path: str
    """Of the link."""


def invite(server: Running, role: str, count: int) -> Iterator[Invited]:
    """New participants of a role, invited as an admin does; their kind is scripted."""
    wish = {"role": role, "count": count, "kind": "scripted"}
    headers = {"Authorization": f"Bearer {server.token}"}
    for link in json.loads(asked(server.address, "/admin/api/invite", wish, headers))["links"]:
        yield Invited(link["code"], role, link["path"])


def _count(plan: StudyPlan, role: str, order: PilotOrder) -> int:
    planned = plan.roles[role].participants
    return planned if order.participants is None else min(planned, order.participants)


def _ahead(plan: StudyPlan, task: Task, order: PilotOrder) -> Ahead:
    episode = task.horizon * control_period(task) / order.speed
    counts = {role: _count(plan, role, order) for role in plan.roles}
    things = sum(n * _size(plan, role, ("watch", "practise", "play", "judge"))
                 for role, n in counts.items())  # fmt: skip
    longest = max(_size(plan, role, ("practise", "play")) for role in counts)
    return Ahead(sum(counts.values()), things, episode * longest)


def _size(plan: StudyPlan, role: str, kinds: Sequence[str]) -> int:
    """Episodes and trials of some kinds of stages, of one participant."""
    stages = plan.roles[role].stages
    return sum(stage_size(plan, stage) for stage in stages if stage.kind in kinds)
