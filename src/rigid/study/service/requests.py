"""From a request to who sent it and what they said; refused before it costs anything."""

from __future__ import annotations

import asyncio
import re
from typing import Final, TypeVar

from pydantic import BaseModel
from starlette.requests import HTTPConnection, Request
from starlette.responses import JSONResponse

from rigid.study.records import Participant
from rigid.study.service.context import Service
from rigid.study.service.limits import network
from rigid.study.service.messages import BODY_BYTES, read_message
from rigid.study.service.refusing import Refusal

_Said = TypeVar("_Said", bound=BaseModel)
_TOKEN: Final = re.compile(r"[A-Za-z0-9_-]{16,64}", re.ASCII)
BODY_SECONDS: Final = 10.0
"""How long a body may take to arrive [s]. Ours."""


def service_of(connection: HTTPConnection) -> Service:
    """The service that a request came to."""
    service: Service = connection.app.state.service
    return service


def address_of(connection: HTTPConnection) -> str:
    """Whose address it came from; what headers say of it is anybody's word."""
    return network(connection.client.host if connection.client else None)


async def participant_of(connection: HTTPConnection) -> Participant:
    """Who holds the token in the path.

    Raises:
        Refusal: Nobody does.
    """
    service = service_of(connection)
    token = connection.path_params["token"]
    found = None
    if _TOKEN.fullmatch(token):
        found = await service.desk.do(service.store.participant_by_token, token)
    if found is None:
        service.allow(service.rates.strangers, address_of(connection))
        raise Refusal("unknown-token", "this link is not known: ask whoever invited you")
    return found


async def body_of(request: Request, kind: type[_Said]) -> _Said:
    """The message in the body of a request.

    Raises:
        Refusal: It is no JSON, not of this kind, too large or too slow.
    """
    declared = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if declared != "application/json":  # Other sites' forms cannot say so.
        raise Refusal("not-json", "send JSON, with content type application/json")
    try:
        async with asyncio.timeout(BODY_SECONDS):
            return read_message(kind, await _small_body(request))
    except TimeoutError:
        raise Refusal("too-slow", "the request took too long to arrive") from None


async def _small_body(request: Request) -> bytes:
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > BODY_BYTES:
            raise Refusal("too-large", f"more than {BODY_BYTES // 1024} kB are not taken")
    return bytes(body)


def refused(refusal: Refusal) -> JSONResponse:
    """The answer to what was refused."""
    headers = {"Connection": "close"} if refusal.code in _ENDS else {}
    return JSONResponse(
        {"error": refusal.code, "message": refusal.message},
        status_code=refusal.status,
        headers=headers,
    )


_ENDS: Final = {"too-large", "too-slow", "too-many", "not-json"}
"""After these the rest of a body may still be on its way, and is not read."""
