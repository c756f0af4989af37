"""Thirty at once: how evenly do frames come, and is anything lost?"""

from __future__ import annotations

import asyncio
import json
import math
import os
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.people.player import Player
from benchmarks.people.server import COMMAND, StudyServer
from benchmarks.study import say
from rigid.errors import UserError
from rigid.study.store import Store

GOAL_MS = 120.0
"""The 95th percentile of the period must stay below [ms]; 100 is exact."""
_EPISODE_SECONDS = 10.0


def measure_load(
    clients: int, seconds: float, *, kill: bool, command: Sequence[str] = COMMAND
) -> dict[str, Any]:
    """Runs server and players, and says what was found.

    Args:
        clients: How many play at once.
        seconds: How long.
        kill: Whether the server is killed half-way.
        command: What starts the server.

    Raises:
        UserError: Fewer than one client, or too little time for an episode.
    """
    if clients < 1 or seconds < 2 * _EPISODE_SECONDS:
        raise UserError("give at least one client and 0.4 minutes")
    with tempfile.TemporaryDirectory(prefix="rigid-load-") as folder:
        study = Path(folder) / "study.yaml"
        study.write_text(study_file(clients, seconds))
        say("starting the server")
        data = Path(folder) / "data"
        with StudyServer(data, "--study", str(study), command=command) as server:
            say(f"{clients} players for {seconds:.0f} s" + (", kill -9 half-way" * kill))
            found = asyncio.run(_run(server, clients, seconds, kill=kill))
            found["stopped_with"] = server.stop()
        found |= _kept(data, found.pop("acknowledged"))
    return {**found, "ok": holds(found)}


def study_file(clients: int, seconds: float) -> str:
    """A study long enough to play in all the while."""
    episodes = math.ceil(seconds / _EPISODE_SECONDS) + 1
    return json.dumps(  # JSON is YAML.
        {
            "title": "Load", "robots": {"a": "builtin:vanilla"}, "demographics": False,
            "roles": {
                "novice": {
                    "participants": clients,
                    "stages": [
                        {"kind": "watch", "episodes": 1},
                        {"kind": "practise", "episodes": 1},
                        {"kind": "play", "episodes": episodes},
                    ],
                }
            },
        }
    )  # fmt: skip


async def _run(server: StudyServer, clients: int, seconds: float, *, kill: bool) -> dict[str, Any]:
    tokens = await asyncio.to_thread(server.invite, "novice", clients)
    players = [
        Player(server.address, token, phase=2 * math.pi * number / clients)
        for number, token in enumerate(tokens)
    ]
    begin, processor = time.monotonic(), server.processor_seconds
    load_before = round(os.getloadavg()[0], 1)
    playing = [
        asyncio.create_task(_staggered(player, number / clients, begin + seconds))
        for number, player in enumerate(players)
    ]
    down = None
    if kill:
        await asyncio.sleep(seconds / 2)
        down = await asyncio.to_thread(_kill_and_restart, server)
    await asyncio.gather(*playing)
    took = time.monotonic() - begin
    progress = await asyncio.to_thread(server.admin, "progress")
    seen = [player.seen for player in players]
    return {
        "clients": clients, "seconds": round(took, 1), "killed": kill, "down_seconds": down,
        "period_ms": distribution(p for one in seen for p in one.periods),
        "server_period_ms": progress["since_start"]["period_ms"],
        "episodes": sum(len(one.finished) for one in seen),
        "fewest_episodes": min(len(one.finished) for one in seen),
        "broken_off": sum(one.broken_off for one in seen),
        "refused": {k: v for one in seen for k, v in one.refused.items()},
        "resumed_wrongly": [text for one in seen for text in one.resumed_wrongly],
        "server_cores": round((server.processor_seconds - processor) / took, 2),
        "cores": os.cpu_count(), "load_average": [load_before, round(os.getloadavg()[0], 1)],
        "acknowledged": [(place, *one) for place, who in enumerate(seen) for one in who.finished],
    }  # fmt: skip


async def _staggered(player: Player, share: float, until: float) -> None:
    """People do not begin in the same instant."""
    await asyncio.sleep(2 * share)
    await player.play(until)


def _kill_and_restart(server: StudyServer) -> float:
    """How long nobody answered [s]."""
    begin = time.monotonic()
    server.kill()
    say("killed; starting again")
    server.restart()
    return round(time.monotonic() - begin, 1)


def _kept(data: Path, acknowledged: Iterable[tuple[int, str, int]]) -> dict[str, Any]:
    """Which acknowledged episodes are in the store, and whole."""
    with Store.read(data) as store:
        codes = [person.code for person in store.participants()]
        kept = {(one.participant, one.kind, one.number): one for one in store.episodes()}
    told = [(codes[place], kind, number) for place, kind, number in acknowledged]
    lost = [one for one in told if one not in kept]
    whole = all(len(one.arrays.rewards) + 1 == len(one.arrays.states) for one in kept.values())
    again = sum(one.attempts > 1 for one in kept.values())
    return {
        "stored": len(kept), "lost": len(lost), "whole": whole, "began_anew": again,
    }  # fmt: skip


def distribution(periods: Iterable[float]) -> dict[str, float] | None:
    """Of periods in seconds, in milliseconds; None of none.

    Example:
        >>> distribution([0.1, 0.1, 0.1])["p95"]
        100.0
    """
    values = 1000 * np.fromiter(periods, float)
    if not len(values):
        return None
    p50, p95, p99 = (round(float(value), 1) for value in np.percentile(values, (50, 95, 99)))
    most = round(float(values.max()), 1)
    return {"p50": p50, "p95": p95, "p99": p99, "max": most, "frames": len(values)}


def holds(found: dict[str, Any]) -> bool:
    """Whether the service kept its promises.

    Example:
        >>> good = {"period_ms": {"p95": 104.0}, "lost": 0, "whole": True, "resumed_wrongly": []}
        >>> holds(good), holds(good | {"lost": 1})
        (True, False)
    """
    pace = found["period_ms"]
    in_time = pace is not None and pace["p95"] < GOAL_MS
    return in_time and found["lost"] == 0 and found["whole"] and not found["resumed_wrongly"]
