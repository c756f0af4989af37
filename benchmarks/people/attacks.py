"""Hostile messages of many kinds. Each is one message, and must be refused and counted as one."""

from __future__ import annotations

import json
import random
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any

import httpx
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from benchmarks.people.wire import answer_to, close_code_of, handshake, request

Attack = Callable[["Attacker"], Awaitable[bool]]
"""Sends one message; tells whether it was refused."""
DEEP = "[" * 5000 + "]" * 5000


@dataclass
class Attacker:
    """Somebody with a link of their own, who uses it badly."""

    port: int
    token: str
    rng: random.Random
    client: httpx.AsyncClient
    socket: ClientConnection | None = None
    n: int = field(default=0)

    @property
    def path(self) -> str:
        """Of their page."""
        return f"/p/{self.token}"

    def foreign(self) -> str:
        """A token that nobody has."""
        letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_"
        return "".join(self.rng.choices(letters, k=32))

    async def post(self, what: str, body: bytes, **headers: str) -> bool:
        """To their own page."""
        answer = await self.client.post(
            f"http://127.0.0.1:{self.port}{self.path}/api/{what}", content=body,
            headers={"Content-Type": "application/json", **headers},
        )  # fmt: skip
        return httpx.codes.is_client_error(answer.status_code)

    async def raw(self, *parts: bytes) -> bool:
        """Over a socket of its own."""
        status = await answer_to(self.port, *parts)
        return status is None or httpx.codes.is_client_error(status)

    async def live(self, message: str | bytes, *, text: bool | None = None) -> bool:
        """Over their WebSocket; True where it is refused, or closes."""
        try:
            await (await self.opened()).send(message, text=text)
            said = json.loads(await (await self.opened()).recv())
        except (ConnectionClosed, InvalidStatus):
            self.socket = None
            return True
        return bool(said["type"] == "refused")

    async def opened(self) -> ClientConnection:
        """Their WebSocket."""
        if self.socket is None:
            address = f"ws://127.0.0.1:{self.port}{self.path}/live"
            self.socket, self.n = await connect(address, compression=None), 0
        return self.socket

    async def close(self) -> None:
        """Ends their WebSocket."""
        if self.socket is not None:
            await self.socket.close()
            self.socket = None

    async def live_fields(self, **fields: Any) -> bool:
        """A live message of JSON, with the next `n` unless it names one."""
        self.n += 1
        return await self.live(json.dumps({"n": self.n, **fields}))


async def foreign_token(a: Attacker) -> bool:
    """Reads with a token that nobody has."""
    what = a.rng.choice(("/api/state", "/api/scene", "", "/api/clip/c0", "/api/texts"))
    return await a.raw(request(f"GET /p/{a.foreign()}{what} HTTP/1.1"))


async def strange_token(a: Attacker) -> bool:
    """A token that is no token."""
    token = a.rng.choice(
        ("%00", "..", "null", "' OR 1=1 --".replace(" ", "%20"), "%ff" * 9, "x" * 4000)
    )
    return await a.raw(request(f"GET /p/{token}/api/state HTTP/1.1"))


async def path_trick(a: Attacker) -> bool:
    """Files and doors that are not for them."""
    path = a.rng.choice((
        "/static/../../../../etc/passwd", "/static/%2e%2e/%2e%2e/records.py", "/static/",
        "/static/..%2fpage.html", "/static/study.sqlite3", "//admin/", "/admin/", "/admin%2f",
        "/admin/../admin/api/progress", "/./admin/api/export", "/admin/admin.js", "/Admin/",
        "/admin/api/invite/", "/p/../admin/", "/p/", "/p", "/.git/config", "/study.sqlite3",
        f"{a.path}/../../admin/api/progress", f"{a.path}/api/clip/..%2f..%2fstudy.sqlite3",
        f"{a.path}/api/clip/c99", f"{a.path}/api/clip/%00", f"{a.path}/api/",
        f"{a.path}/api/state/x", "/%2e%2e/%2e%2e/etc/passwd",
    ))  # fmt: skip
    return await a.raw(request(f"GET {path} HTTP/1.1"))


async def wrong_method(a: Attacker) -> bool:
    """Methods that are not taken there."""
    method = a.rng.choice(("DELETE", "PUT", "PATCH", "OPTIONS", "TRACE", "PROPFIND", "X"))
    what = a.rng.choice(("state", "consent", "withdraw", "stop"))
    return await a.raw(request(f"{method} {a.path}/api/{what} HTTP/1.1", "Content-Length: 0"))


async def admin_without_token(a: Attacker) -> bool:
    """The admin's side, with a wrong key or a header that pretends."""
    header = a.rng.choice((
        "Authorization: Bearer x", "Authorization: Basic YWRtaW46YWRtaW4=",
        "X-Forwarded-For: 127.0.0.1", "Cookie: rigid-admin=1", "X-Original-URL: /admin/",
        f"Authorization: Bearer {a.token}",
        f"Cookie: rigid-admin={'x' * 3000}", "Authorization: Bearer \u00ff\u00fe",
        "Forwarded: for=127.0.0.1",
    ))  # fmt: skip
    path = a.rng.choice(("/admin/", "/admin/api/progress", "/admin/api/export", "/admin/?token=x"))
    return await a.raw(request(f"GET {path} HTTP/1.1", header))


async def wrong_types(a: Attacker) -> bool:
    """JSON of the right shape and the wrong types."""
    odd: Any = a.rng.choice((None, True, "1", 1.5, -1, [], {}, [[]], "\u0000", 10**30))
    what, said = a.rng.choice((
        ("consent", {"version": odd, "agreed": "yes", "sharing": False}),
        ("consent", {"version": "1", "agreed": 1}),
        ("demographics", {"age": [odd]}),
        ("demographics", {"shoe_size": 43}),
        ("demographics", {"gender": "'; DROP TABLE participants; --"}),
        ("calibration", {"arm_length": "long", "seat_height": 0.5}),
        ("calibration", {"arm_length": -0.7, "seat_height": 0.5}),
        ("watched", {"stage": "0", "episode": "c0"}),
        ("watched", {"stage": 0, "episode": "../c0"}),
        ("watched", {"stage": 10**15, "episode": "c0"}),
        ("answer", {"stage": 0, "trial": odd, "responses": {"goal-left": 3}, "rt": 1}),
        ("answer", {"stage": 0, "trial": "t00", "responses": {"goal-left": 99}, "rt": 1}),
        ("answer", {"stage": 99, "trial": "t00", "responses": {"correspondence": "left"}, "rt": 1}),
        ("withdraw", {"confirm": odd}), ("withdraw", {}), ("stop", {"now": odd}),
        ("consent", {"version": "1", "agreed": True, "__proto__": {"admin": True}}),
    ))  # fmt: skip
    return await a.post(what, json.dumps(said).encode())


async def no_json(a: Attacker) -> bool:
    """Bodies that are no JSON, or more than JSON."""
    body = a.rng.choice((
        b"", b"{", b"null", b"[]", b"\xff\xfe\x00", b'{"version": "\xff"}', DEEP.encode(),
        b'{"confirm": NaN}', b'{"arm_length": Infinity, "seat_height": 0.5}', a.rng.randbytes(200),
        b'{"arm_length": 1e999, "seat_height": 0.5}', b"version=1&agreed=true", b"\x00" * 100,
        ('{"a":' * 3000 + "1" + "}" * 3000).encode(), b'{"confirm": "withdraw",}',
    ))  # fmt: skip
    return await a.post(a.rng.choice(("calibration", "withdraw", "watched", "answer")), body)


async def wrong_kind(a: Attacker) -> bool:
    """A form of another site."""
    kind = a.rng.choice(("text/plain", "application/x-www-form-urlencoded", "multipart/form-data"))
    return await a.post("withdraw", b'{"confirm": "withdraw"}', **{"Content-Type": kind})


async def huge_body(a: Attacker) -> bool:
    """More than 64 kB, said beforehand or not."""
    size = a.rng.choice((70_000, 200_000, 1_000_000))
    if a.rng.random() < 0.5:
        head = request(
            f"POST {a.path}/api/answer HTTP/1.1", "Content-Type: application/json",
            "Transfer-Encoding: chunked",
        )  # fmt: skip
        return await a.raw(head + b"%x\r\n" % size + b"[" * size + b"\r\n")
    head = request(
        f"POST {a.path}/api/answer HTTP/1.1", "Content-Type: application/json",
        f"Content-Length: {size}",
    )  # fmt: skip
    return await a.raw(head + b"[" * min(size, 300_000))


async def no_http(a: Attacker) -> bool:
    """What is no HTTP, and requests that would be two."""
    path = f"{a.path}/api/state"
    return await a.raw(a.rng.choice((
        a.rng.randbytes(300) + b"\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",
        b"GET\r\n\r\n", b"\x00\r\n\r\n",
        request(f"GET {path} HTTP/1.1", "Content-Length: 5", "Content-Length: 6"),
        request(f"GET {path} HTTP/1.1", "Content-Length: 99999999999999999999999999"),
        request(f"GET {path} HTTP/1.1", "Content-Length: -1"),
        request(f"GET {path} HTTP/1.1", "Transfer-Encoding: chunked, identity"),
        request(f"GET {path} HTTP/1.1", "X: " + "y" * 400_000),
        request(f"GET {path}\u00e9 HTTP/1.1"), request(f"GET {path} HTTP/1.1", "bad header: x"),
        request(
            f"POST {a.path}/api/answer HTTP/1.1", "Content-Type: application/json",
            "Transfer-Encoding: chunked", body=b"zz\r\n",
        ),
    )))  # fmt: skip


async def bad_handshake(a: Attacker) -> bool:
    """No WebSocket, or none of theirs."""
    live = f"{a.path}/live"
    return await a.raw(a.rng.choice((
        handshake(live, key=False), handshake(live, version=8), handshake("/admin/live"),
        handshake("/"), handshake(f"{a.path}/api/state"),
    )))  # fmt: skip


async def foreign_live(a: Attacker) -> bool:
    """Live play with a token that nobody has."""
    return await close_code_of(a.port, f"/p/{a.foreign()}/live", b"") is not None


async def bad_frames(a: Attacker) -> bool:
    """WebSocket frames that are none."""
    frames = a.rng.choice((
        b"\x81\x05hello",  # Not masked, as clients must.
        b"\x83\x80\x00\x00\x00\x00",  # An unknown kind.
        b"\xf1\x80\x00\x00\x00\x00",  # Reserved bits.
        b"\x81\x82\x00\x00\x00\x00\xff\xfe",  # No UTF-8.
        b"\x81\xff\x00\x00\x7f\xff\xff\xff\xff\xff\x00\x00\x00\x00",  # 140 TB.
        b"\x09\x80\x00\x00\x00\x00",  # A ping in pieces.
        b"\x80\x80\x00\x00\x00\x00",  # The rest of nothing.
        b"\x81\xfe\x7f\xff\x00\x00\x00\x00" + b"x" * 0x7FFF,  # 32 kB.
    ))  # fmt: skip
    a.socket = None
    return await close_code_of(a.port, f"{a.path}/live", frames) is not None


async def live_no_json(a: Attacker) -> bool:
    """Live messages that are no JSON."""
    message = a.rng.choice(
        ("", "{", "null", "[]", DEEP[:4000], '"start"', "\u0000", "NaN", "{}" * 50)
    )
    return await a.live(message)


async def live_bytes(a: Attacker) -> bool:
    """Live messages that are no text."""
    return await a.live(a.rng.randbytes(a.rng.randrange(1, 500)))


async def live_too_large(a: Attacker) -> bool:
    """A live message of more than 8 kB."""
    return await a.live(
        '{"type": "ping", "n": 1, "sent": ' + "1" * a.rng.randrange(9000, 90_000) + "}"
    )


async def live_no_text(a: Attacker) -> bool:
    """A text that is no UTF-8."""
    return await a.live(b'{"type": "\xff\xfe"}', text=True)


async def live_wrong_types(a: Attacker) -> bool:
    """Live messages of wrong types."""
    odd: Any = a.rng.choice((None, "1", 1.5, True, -1, [], {}, 2**60, 1e400))
    return await a.live_fields(**a.rng.choice((
        {"type": "target", "step": 0, "position": [float("nan"), 0, 0]},
        {"type": "target", "step": 0, "position": [0, float("inf"), 0]},
        {"type": "target", "step": 0, "position": [1e308, 0, 0]},
        {"type": "target", "step": 0, "position": [0, 0]},
        {"type": "target", "step": 0, "position": [0, 0, 0, 0]},
        {"type": "target", "step": 0, "position": {"x": 0}},
        {"type": "target", "step": odd, "position": ["0", 0, 0]},
        {"type": "start", "device": "mind"}, {"type": "start", "device": odd},
        {"type": "start", "device": "mouse", "about": {str(i): i for i in range(100)}},
        {"type": "start", "device": "mouse", "robot": "easier"},
        {"type": "start", "device": "mouse", "about": [odd]},
        {"type": "ping", "sent": "now"}, {"type": "ping"}, {"type": "admin"}, {"type": odd}, {},
        {"type": "target", "step": 0, "position": [0, 0, 0], "n": odd},
        {"type": "stop", "n": -5}, {"type": "stop", "number": 1},
    )))  # fmt: skip


async def live_replayed(a: Attacker) -> bool:
    """A number that was used before."""
    try:
        await a.opened()
        a.n += 1
        if await a.live_fields(type="ping", sent=1.0):
            return True
    except InvalidStatus:
        return True
    return await a.live_fields(type="ping", sent=1.0, n=a.rng.randrange(a.n + 1))


async def live_not_now(a: Attacker) -> bool:
    """An episode before they have consented."""
    return await a.live_fields(type="start", device="mouse")


ATTACKS: tuple[Attack, ...] = (
    foreign_token, strange_token, path_trick, wrong_method, admin_without_token, wrong_types,
    no_json, wrong_kind, huge_body, no_http, bad_handshake, foreign_live, bad_frames, live_no_json,
    live_bytes, live_too_large, live_no_text, live_wrong_types, live_replayed, live_not_now,
)  # fmt: skip
