"""The desk of whoever runs the study: everything below /admin/, closed to everybody else."""

from __future__ import annotations

import datetime as dt
import secrets
from contextlib import suppress
from importlib import resources
from typing import Final

import numpy as np
from starlette.requests import HTTPConnection, Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route, Router
from starlette.types import ASGIApp, Receive, Scope, Send

from rigid.errors import UserError
from rigid.study.service import messages
from rigid.study.service.context import Service
from rigid.study.service.exports import in_chunks, zipped_export
from rigid.study.service.public_routes import plain_page
from rigid.study.service.refusing import Refusal
from rigid.study.service.requests import address_of, body_of, refused, service_of

COOKIE: Final = "rigid-admin"
_TYPES = {"admin.html": "text/html", "admin.js": "text/javascript", "admin.css": "text/css"}
_PACKAGE = resources.files("rigid.study.service")
_SESSIONS = 1000


def admin_app() -> ASGIApp:
    """Everything below /admin."""
    return Gate(
        Router(
            [
                Route("/", _page, methods=["GET"]),
                Route("/api/progress", _progress, methods=["GET"]),
                Route("/api/invite", _invite, methods=["POST"]),
                Route("/api/export", _export, methods=["GET"]),
                Route("/{name}", _file, methods=["GET"]),
            ]
        )
    )


class Gate:
    """Lets in who holds the admin's token, as `Authorization: Bearer`, cookie or `?token=`."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """As ASGI has it."""
        connection = HTTPConnection(scope)
        service = service_of(connection)
        if await _is_admin(service, connection):
            await self._app(scope, receive, send)
            return
        allowed = service.rates.strangers.take(address_of(connection), service.clock())
        code = "unknown-token" if allowed else "too-many"
        service.refusals.count("admin", code)
        response = _closed(service, connection, code)
        response.headers["WWW-Authenticate"] = "Bearer"
        await response(scope, receive, send)


def _closed(service: Service, connection: HTTPConnection, code: str) -> Response:
    """What strangers see: people a page, programs JSON."""
    refusal = Refusal(code, "open the admin link that was printed at the start")
    if connection.url.path != "/admin/":
        return refused(refusal)
    page = plain_page(service, "admin")
    return Response(page, status_code=refusal.status, media_type="text/html")


async def _is_admin(service: Service, connection: HTTPConnection) -> bool:
    cookie = connection.cookies.get(COOKIE)
    if cookie is not None and cookie in service.sessions:
        return True
    scheme, _, token = connection.headers.get("authorization", "").partition(" ")
    if scheme.lower() != "bearer":
        token = connection.query_params.get("token", "")
    if not 1 <= len(token) <= 200:
        return False
    return await service.desk.do(service.store.is_admin, token.strip())


async def _page(request: Request) -> Response:
    service = service_of(request)
    response = _packaged("admin.html")
    if "token" in request.query_params:  # The page takes it out of the address.
        session = secrets.token_urlsafe(24)
        if len(service.sessions) >= _SESSIONS:
            service.sessions.clear()
        service.sessions.add(session)
        response.set_cookie(
            COOKIE, session, path="/admin", httponly=True, samesite="strict",
            secure=_over_tls(service, request),
        )  # fmt: skip
    return response


def _over_tls(service: Service, request: Request) -> bool:
    """Whether it came over HTTPS, if only as far as a proxy that passes on the address."""
    proxied = service.address == f"https://{request.headers.get('host')}"
    return proxied or request.url.scheme == "https"


async def _file(request: Request) -> Response:
    name = request.path_params["name"]
    if name not in _TYPES:
        raise Refusal("not-found", "there is no such page")
    return _packaged(name)


def _packaged(name: str) -> Response:
    return Response((_PACKAGE / name).read_bytes(), media_type=_TYPES[name])


async def _progress(request: Request) -> Response:
    service = service_of(request)
    with suppress(UserError):  # Counts may wait; how far everybody is must not.
        await service.keep_refusals()
    found = await service.desk.do(service.store.progress)
    return JSONResponse(
        {
            "title": service.plan.title,
            "address": service.address,
            "roles": {name: role.participants for name, role in service.plan.roles.items()},
            "participants": [
                person._asdict() | {"playing": person.code in service.live}
                for person in found.participants
            ],
            "withdrawn": list(found.withdrawn),
            "refused": dict(found.refused),
            "since_start": {
                "refused": service.refusals.by_reason(),
                "connected": len(service.live),
                "period_ms": _periods(service),
            },
            "now": dt.datetime.now(dt.UTC).isoformat(timespec="seconds"),
        }
    )


def _periods(service: Service) -> dict[str, float] | None:
    """How evenly the last steps followed each other [ms]; None before the first."""
    if not service.periods:
        return None
    periods = 1000 * np.array(service.periods)
    p50, p95, p99 = np.percentile(periods, (50, 95, 99))
    return {
        "p50": round(float(p50), 1), "p95": round(float(p95), 1), "p99": round(float(p99), 1),
        "max": round(float(periods.max()), 1), "steps": len(periods),
    }  # fmt: skip


async def _invite(request: Request) -> Response:
    service = service_of(request)
    wish = await body_of(request, messages.Invite)
    if wish.role not in service.plan.roles:
        known = ", ".join(service.plan.roles)
        raise Refusal("invalid", f"there is no such role: the study has {known}")
    if wish.external_id is not None and wish.count != 1:
        raise Refusal("invalid", "an external id belongs to one participant: count must be 1")
    made = []
    for _ in range(wish.count):
        try:
            invitation = await service.desk.do(
                service.store.invite, wish.role, external_id=wish.external_id, kind=wish.kind
            )
        except UserError as error:
            raise Refusal("not-now", str(error)) from None
        path = f"/p/{invitation.token}"
        made.append({"code": invitation.code, "path": path, "link": service.address + path})
    return JSONResponse({"role": wish.role, "links": made})


async def _export(request: Request) -> Response:
    service = service_of(request)
    shareable = request.query_params.get("shareable") in {"1", "true"}
    try:
        file = await service.exporting.do(zipped_export, service.data, shareable=shareable)
    except UserError as error:
        raise Refusal("not-now", str(error)) from None
    name = f"study-{'shareable-' if shareable else ''}{dt.datetime.now(dt.UTC):%Y%m%d-%H%M}.zip"
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return StreamingResponse(in_chunks(file), media_type="application/zip", headers=headers)
