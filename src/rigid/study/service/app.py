"""The application: doors, headers, and the answer to everything that is refused."""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any, Final

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.websockets import WebSocket

from rigid.errors import UserError
from rigid.study.service.admin_routes import admin_app
from rigid.study.service.context import Service
from rigid.study.service.headers import SecurityHeaders
from rigid.study.service.participant_routes import participant_routes
from rigid.study.service.public_routes import plain_page, public_routes
from rigid.study.service.refusing import STATUS_OF_CODE, Refusal
from rigid.study.service.requests import address_of, refused, service_of

KEEP_SECONDS: Final = 5.0
"""How often what was refused is written down [s]. Ours."""
_CODES = {status: code for code, status in STATUS_OF_CODE.items()}
_log = logging.getLogger(__name__)


def build_app(service: Service) -> Starlette:
    """The application of one study; it closes the service when it ends."""

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[dict[str, Any]]:
        del app
        asyncio.get_running_loop().set_exception_handler(_counted(service))
        keeping = asyncio.create_task(_keep_refusals(service))
        try:
            yield {"refusals": service.refusals, "connected": Counter[str]()}
        finally:
            keeping.cancel()
            with suppress(asyncio.CancelledError):
                await keeping
            try:
                await service.keep_refusals()
            except UserError as error:
                _log.warning("the last counts of refusals are lost: %s", error)

    app = Starlette(
        routes=[
            *public_routes(),
            *participant_routes(),
            Route("/favicon.ico", _no_icon),
            Route("/admin", _to_admin),
            Mount("/admin", app=admin_app()),
            WebSocketRoute("/{path:path}", _no_live),
        ],
        middleware=[Middleware(SecurityHeaders)],
        exception_handlers={
            Refusal: _on_refusal,
            HTTPException: _on_http,
            ClientDisconnect: _on_broken_off,
            Exception: _on_fault,
        },
        lifespan=lifespan,
    )
    app.router.redirect_slashes = False  # A redirect would repeat whatever host was named.
    app.state.service = service
    return app


async def _to_admin(request: Request) -> Response:
    """Within the same host, whatever it is called, and with the token if there is one."""
    query = request.url.query
    return Response(status_code=307, headers={"Location": "/admin/" + f"?{query}" * bool(query)})


async def _no_icon(request: Request) -> Response:
    del request
    return Response(status_code=204)


async def _on_refusal(request: Request, error: Exception) -> Response:
    assert isinstance(error, Refusal)
    service = service_of(request)
    service.refusals.count(_door(request), error.code)
    is_page = request.url.path.startswith("/p/") and "/api/" not in request.url.path
    if error.code == "unknown-token" and is_page:
        return Response(
            plain_page(service, "unknown_link"), status_code=401, media_type="text/html"
        )
    return refused(error)


async def _no_live(socket: WebSocket) -> None:
    service_of(socket).refusals.count("live", "not-found")
    await socket.send_denial_response(Response(status_code=404))


async def _on_broken_off(request: Request, error: Exception) -> Response:
    """Nobody is there to hear an answer."""
    del request, error
    return Response(status_code=400)


async def _on_http(request: Request, error: Exception) -> Response:
    """No such path, or no such method there."""
    assert isinstance(error, HTTPException)
    service = service_of(request)
    code = _CODES.get(error.status_code, "not-found")
    if not service.rates.strangers.take(address_of(request), service.clock()):
        code = "too-many"
    service.refusals.count(_door(request), code)
    answer = refused(Refusal(code, "there is nothing here"))
    if error.headers:
        answer.headers.update(error.headers)
    return answer


async def _on_fault(request: Request, error: Exception) -> Response:
    """A mistake of ours; what was asked for has no effect."""
    _log.error("a request failed", exc_info=error)
    service_of(request).refusals.count(_door(request), "fault")
    return JSONResponse({"error": "fault", "message": "the server failed"}, status_code=500)


def _door(request: Request) -> str:
    return "admin" if request.url.path.startswith("/admin") else "http"


async def _keep_refusals(service: Service) -> None:
    """Every few seconds; what cannot be written is tried again, and said once."""
    said = False
    while True:
        await asyncio.sleep(KEEP_SECONDS)
        try:
            await service.keep_refusals()
            said = False
        except UserError as error:
            if not said:
                _log.warning("counts of refusals wait to be written: %s", error)
            said = True


def _counted(service: Service) -> Any:
    """A handler for what breaks below the application: bytes that upset a protocol."""

    def handle(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        del loop
        service.refusals.count("wire", "fault")
        error = context.get("exception")
        _log.warning("%s: %s", context.get("message"), type(error).__name__)

    return handle
