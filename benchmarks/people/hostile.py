"""Ten thousand hostile messages, while somebody else plays undisturbed."""

from __future__ import annotations

import asyncio
import random
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import httpx

from benchmarks.people.attacks import ATTACKS, Attacker
from benchmarks.people.load import distribution, study_file
from benchmarks.people.player import Player
from benchmarks.people.server import COMMAND, StudyServer
from benchmarks.study import say
from rigid.errors import UserError
from rigid.study.store import Store

_ATTACKERS = 60
"""Links in hostile hands: each has a right to so many messages a second, and no more."""
_AT_ONCE = 4
_LONGEST = 3600.0
"""Of the other's play [s]; it ends with the attack."""


def measure_hostile(
    messages: int, seed: int, *, command: Sequence[str] = COMMAND
) -> dict[str, Any]:
    """Attacks a server, and says what became of it, of the messages and of the other player.

    Args:
        messages: How many.
        seed: Of their draw.
        command: What starts the server.

    Raises:
        UserError: No messages.
    """
    if messages < 1:
        raise UserError(f"--messages is {messages}, but must be at least 1")
    with tempfile.TemporaryDirectory(prefix="rigid-hostile-") as folder:
        study, data = Path(folder) / "study.yaml", Path(folder) / "data"
        study.write_text(study_file(_ATTACKERS + 1, _LONGEST))
        say("starting the server")
        with StudyServer(data, "--study", str(study), command=command) as server:
            say(f"{messages} hostile messages of {len(ATTACKS)} kinds")
            found = asyncio.run(_run(server, messages, seed))
            found["alive"] = server.alive
            server.stop()
        found["tracebacks"] = server.log.read_text().count("Traceback")
        found |= _effects(data, found.pop("finished"))
    return {**found, "ok": held(found)}


async def _run(server: StudyServer, messages: int, seed: int) -> dict[str, Any]:
    good, *hostile = await asyncio.to_thread(server.invite, "novice", _ATTACKERS + 1)
    player = Player(server.address, good)
    playing = asyncio.create_task(player.play(time.monotonic() + _LONGEST))
    begin, accepted, sent = time.monotonic(), Counter[str](), Counter[str]()
    async with httpx.AsyncClient(timeout=60) as client:
        attackers = [
            Attacker(server.port, token, random.Random(f"{seed}/{place}"), client)  # noqa: S311 - no secrets.
            for place, token in enumerate(hostile)
        ]
        shares = [messages // _AT_ONCE + (place < messages % _AT_ONCE) for place in range(_AT_ONCE)]
        await asyncio.gather(
            *(
                _attack(attackers[place::_AT_ONCE], share, seed + place, sent, accepted)
                for place, share in enumerate(shares)
            )
        )
        for attacker in attackers:
            await attacker.close()
    took = time.monotonic() - begin
    player.last_episode()
    await playing
    progress = await asyncio.to_thread(server.admin, "progress")
    refused = progress["since_start"]["refused"]
    return {
        "messages": sent.total(), "kinds": dict(sent), "accepted": dict(accepted),
        "counted": sum(refused.values()), "refused": refused, "seconds": round(took, 1),
        "other": {
            "episodes": len(player.seen.finished), "broken_off": player.seen.broken_off,
            "refused": dict(player.seen.refused), "period_ms": distribution(player.seen.periods),
        },
        "finished": list(player.seen.finished),
    }  # fmt: skip


async def _attack(
    attackers: Sequence[Attacker],
    messages: int,
    seed: int,
    sent: Counter[str],
    accepted: Counter[str],
) -> None:
    """One message after another, of every kind, each from the next attacker."""
    rng = random.Random(seed)  # noqa: S311 - no secrets.
    for number in range(messages):
        attack = rng.choice(ATTACKS)
        name = str(getattr(attack, "__name__", attack))
        refused = await attack(attackers[number % len(attackers)])
        sent[name] += 1
        accepted[name] += not refused
        if sent.total() % 1000 == 0:
            say(f"{sent.total()} sent")


def _effects(data: Path, finished: Sequence[tuple[str, int]]) -> dict[str, Any]:
    """What is in the store: the other's episodes, and nothing of the attackers."""
    with Store.read(data) as store:
        good, *others = store.participants()
        kept = [(one.kind, one.number) for one in store.episodes(good.code)]
        touched = [one.code for one in others if one.status != "invited" or one.demographics]
        theirs = sum(1 for one in store.episodes() if one.participant != good.code)
        withdrawn = len(store.withdrawn())
    return {
        "lost": len(set(finished) - set(kept)), "touched": touched, "episodes_of_attackers": theirs,
        "withdrawn": withdrawn,
    }  # fmt: skip


def held(found: dict[str, Any]) -> bool:
    """Whether all was refused and counted, nothing broke, and nobody else noticed."""
    return (
        found["alive"]
        and found["tracebacks"] == 0
        and not any(found["accepted"].values())
        and found["counted"] == found["messages"]
        and found["lost"] == 0
        and not found["touched"]
        and found["episodes_of_attackers"] == found["withdrawn"] == 0
        and found["other"]["broken_off"] == 0
        and not found["other"]["refused"]
        and found["other"]["episodes"] > 0
    )
