"""The server of a pilot: the real one, in a process of its own, on a port that is free.

It differs from `rigid study serve` in one thing alone: its clock may run faster than life.
"""

from __future__ import annotations

import asyncio
import json
import secrets
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import NamedTuple

from rigid.errors import UserError

_WAIT = 60.0
"""How long the server may take to end [s]: episodes that are over are stored first."""


@dataclass(frozen=True)
class Order:
    """What to serve; goes to the process as JSON over a pipe, since it holds the admin's token."""

    study: str
    data: str
    speed: float
    trust: bool
    token: str


class Running(NamedTuple):
    """A server that runs."""

    address: str
    """Such as http://127.0.0.1:40123."""
    token: str
    """The admin's."""


@contextmanager
def pilot_server(study: str, data: Path, *, speed: float, trust: bool) -> Iterator[Running]:
    """Runs a server until the block ends.

    Args:
        study: File, or builtin:NAME.
        data: Where the pilot's data goes.
        speed: Seconds of the study in a second of ours.
        trust: Whether the study's file may name what runs code.

    Raises:
        UserError: It did not start: the message is its own.
    """
    order = Order(study, str(data), speed, trust, secrets.token_urlsafe(24))
    with subprocess.Popen(
        [sys.executable, "-m", "rigid.study.pilot.server"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(json.dumps(asdict(order)))
            process.stdin.close()
            said = json.loads(process.stdout.readline() or "{}")
            if "address" not in said:
                raise UserError(
                    said.get("error", "the server did not start: its error stands above")
                )
            yield Running(said["address"], order.token)
        finally:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(_WAIT)
            except subprocess.TimeoutExpired:
                process.kill()


def main() -> int:
    """Serves what standard input orders; says on one line where, or why not."""
    order = Order(**json.load(sys.stdin))
    try:
        _serve(order)
    except UserError as error:
        print(json.dumps({"error": str(error)}), flush=True)  # noqa: T201 - Standard output is the pipe that `pilot_server` reads.
        return error.exit_code
    except KeyboardInterrupt:
        pass
    return 0


def _serve(order: Order) -> None:
    from rigid.study.plan import load_plan

    plan, data = load_plan(order.study), Path(order.data)  # Before what takes long to import.
    from rigid.study.players import open_players
    from rigid.study.service.opening import open_service
    from rigid.study.service.running import address_of_server, listen, serve
    from rigid.study.store import Store
    from rigid.study.store.schema import forget

    task, robots = open_players(plan, trust=order.trust)
    with listen("127.0.0.1", 0) as opened, Store.open(data, plan, new=True) as store:
        address = address_of_server(opened, "127.0.0.1", tls=False)
        try:
            service = open_service(store, plan, task, robots, data=data, address=address)
        except BaseException:
            forget(data)  # Else it would lie in the way of the next pilot.
            raise
        store.set_admin_token(order.token)
        service.clock = lambda: time.monotonic() * order.speed
        service.sleep = lambda seconds: asyncio.sleep(seconds / order.speed)
        print(json.dumps({"address": address}), flush=True)  # noqa: T201 - Standard output is the pipe that `pilot_server` reads.
        serve(service, opened)


if __name__ == "__main__":
    sys.exit(main())
