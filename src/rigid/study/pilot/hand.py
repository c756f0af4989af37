"""How a script plays: over the same live connection as a browser's."""

from __future__ import annotations

import asyncio
import itertools
import json
from typing import TYPE_CHECKING, Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from rigid.errors import UserError
from rigid.study.flow import position
from rigid.study.play.episode import PlayedEpisode
from rigid.study.play.frame import read_frame
from rigid.study.play.scripts import script

if TYPE_CHECKING:
    from rigid.study.pilot.scripted import Scripted

_SILENCE = 30.0
"""Without any message for so long [s], an episode has broken off."""


async def play_stage(who: Scripted, *, of: int) -> None:
    """Plays what is left of a stage.

    Args:
        who: The participant.
        of: Episodes that are left.

    Raises:
        UserError: The server refuses something, or the connection breaks.
    """
    try:
        async with connect(who.page.live, max_size=None, compression=None) as socket:
            numbers = itertools.count()
            for _ in range(of):
                await _play(who, socket, numbers)
                who.tick()
    except (OSError, WebSocketException, TimeoutError) as error:
        raise UserError(f"{who.code}: the live connection broke: {error}") from None


async def _play(who: Scripted, socket: ClientConnection, numbers: itertools.count[int]) -> None:
    """One episode, to the message that it is stored."""
    seen, mover = await asyncio.to_thread(_seen, who), script(who.script)
    first = await asyncio.to_thread(mover.target, 0, seen.hand, seen)  # Some think it all over.
    about = {"pilot": True, "script": who.script}
    await _say(socket, {"type": "start", "n": next(numbers), "device": "scripted", "about": about})
    while True:
        async with asyncio.timeout(_SILENCE):
            message = await socket.recv()
        if isinstance(message, bytes):
            frame = read_frame(message)
            if not frame.done:
                target = first if frame.step == 0 else mover.target(frame.step, frame.hand, seen)
                await _say(socket, {
                    "type": "target", "n": next(numbers), "step": frame.step,
                    "position": [float(value) for value in target],
                })  # fmt: skip
            continue
        said = json.loads(message)
        if said["type"] == "finished":
            return
        if said["type"] == "refused":
            raise UserError(f"{who.code}: a live message was refused: {said['reason']}")


async def _say(socket: ClientConnection, message: dict[str, Any]) -> None:
    await socket.send(json.dumps(message))


def _seen(who: Scripted) -> PlayedEpisode:
    """The start of the episode that comes next: scripts see it as people see the page."""
    following = position(who.plan, who.store, who.store.participant(who.code)).episode
    if following is None:
        raise UserError(f"{who.code}: there is nothing to play, but the page says there is")
    robot = who.players.robots[following.robot]
    return PlayedEpisode(who.players.task, robot, seed=following.seed)
