"""What a participant's page asks for and sends: everything below /p/TOKEN/."""

from __future__ import annotations

import datetime as dt
from collections.abc import Awaitable, Callable

from starlette.background import BackgroundTask
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute

from rigid.errors import UserError
from rigid.study import judging
from rigid.study.plan import WatchStage
from rigid.study.records import Participant
from rigid.study.service import messages
from rigid.study.service.context import Service
from rigid.study.service.demographics import demographics_problem
from rigid.study.service.exports import mend_exports
from rigid.study.service.live import live
from rigid.study.service.refusing import Refusal
from rigid.study.service.requests import body_of, participant_of, service_of
from rigid.study.service.state import Standpoint, standpoint, state_of, withdrawn_state
from rigid.study.store import ConflictError, GoneError

_Handler = Callable[[Service, Participant, Request], Awaitable[Response]]
_JSON = "application/json"


def participant_routes() -> list[Route | WebSocketRoute]:
    """Everything below /p/TOKEN."""
    reads = {"texts": _texts, "state": _state, "scene": _scene, "clip/{key}": _clip}
    writes = {
        "consent": _consent, "demographics": _demographics, "calibration": _calibration,
        "watched": _watched, "answer": _answer, "stop": _stop, "withdraw": _withdraw,
    }  # fmt: skip
    return [
        Route("/p/{token}", _known(_page), methods=["GET"]),
        Route("/p/{token}/", _known(_page), methods=["GET"]),  # As some programs mend links.
        WebSocketRoute("/p/{token}/live", live),
        *(Route(f"/p/{{token}}/api/{n}", _known(h), methods=["GET"]) for n, h in reads.items()),
        *(Route(f"/p/{{token}}/api/{n}", _known(h), methods=["POST"]) for n, h in writes.items()),
    ]


def _known(handler: _Handler) -> Callable[[Request], Awaitable[Response]]:
    """Only for who holds a token, and not too often."""

    async def endpoint(request: Request) -> Response:
        service = service_of(request)
        participant = await participant_of(request)
        service.allow(service.rates.requests, participant.code)
        try:
            return await handler(service, participant, request)
        except (GoneError, ConflictError) as error:
            raise Refusal("not-now", str(error)) from None

    return endpoint


async def _page(service: Service, participant: Participant, request: Request) -> Response:
    del participant, request
    return Response(service.static["page.html"], media_type="text/html")


async def _texts(service: Service, participant: Participant, request: Request) -> Response:
    del participant, request
    return JSONResponse(service.texts)


async def _scene(service: Service, participant: Participant, request: Request) -> Response:
    del participant, request
    return Response(service.scene, media_type=_JSON)


async def _clip(service: Service, participant: Participant, request: Request) -> Response:
    found = service.clips.find(participant, request.path_params["key"])
    if found is None:
        raise Refusal("not-found", "there is no such clip")
    return Response(found, media_type=_JSON)


async def _state(service: Service, participant: Participant, request: Request) -> Response:
    del request
    return JSONResponse(
        await service.desk.do(state_of, service.plan, service.store, participant.code)
    )


async def _consent(service: Service, participant: Participant, request: Request) -> Response:
    said = await body_of(request, messages.Consent)
    where = await _standpoint(service, participant)
    if where.position.kind == "consent":
        consent = service.plan.consent
        if said.version != consent.version:
            raise Refusal("not-now", f"the consent is version {consent.version}: reload the page")
        sharing = said.sharing and consent.sharing
        await service.desk.do(service.store.consent, participant.code, said.version, sharing)
    return await _state(service, participant, request)


async def _demographics(service: Service, participant: Participant, request: Request) -> Response:
    said = await body_of(request, messages.Demographics)
    problem = demographics_problem(said.root)
    if problem is not None:
        raise Refusal("invalid", problem)
    where = await _standpoint(service, participant)
    if where.position.kind == "demographics":
        given = {name: value for name, value in said.root.items() if value is not None}
        await service.desk.do(service.store.demographics, participant.code, given)
    return await _state(service, participant, request)


async def _calibration(service: Service, participant: Participant, request: Request) -> Response:
    said = await body_of(request, messages.Calibration)
    await service.desk.do(service.store.calibrate, participant.code, said.model_dump())
    return await _state(service, participant, request)


async def _watched(service: Service, participant: Participant, request: Request) -> Response:
    said = await body_of(request, messages.Watched)
    stages = service.plan.roles[participant.role].stages
    stage = stages[said.stage] if said.stage < len(stages) else None
    shown = range(stage.episodes) if isinstance(stage, WatchStage) else range(0)
    if said.episode not in {f"c{number}" for number in shown}:
        raise Refusal("invalid", "there is no such episode to watch in this stage")
    await _check_begun(service, participant, said.stage)
    standing = await service.desk.do(service.store.standing, participant.code)
    if said.episode not in standing.watched.get(said.stage, ()):
        await service.desk.do(service.store.watched, participant.code, said.stage, said.episode)
    return await _state(service, participant, request)


async def _answer(service: Service, participant: Participant, request: Request) -> Response:
    said = await body_of(request, messages.Responses)
    try:
        answers = judging.read_answer(
            service.plan, said.stage, participant, trial=said.trial, responses=said.responses,
            rt=said.rt, answered=dt.datetime.now(dt.UTC).isoformat(timespec="milliseconds"),
        )  # fmt: skip
    except UserError as error:
        raise Refusal("invalid", str(error)) from None
    await _check_begun(service, participant, said.stage)
    await service.desk.do(service.store.add_answers, answers)
    return await _state(service, participant, request)


async def _stop(service: Service, participant: Participant, request: Request) -> Response:
    await body_of(request, messages.Stop)
    await _leave_live(service, participant)
    if participant.status in {"invited", "active"}:
        await service.desk.do(service.store.stop, participant.code)
    return await _state(service, participant, request)


async def _withdraw(service: Service, participant: Participant, request: Request) -> Response:
    await body_of(request, messages.Withdraw)
    await _leave_live(service, participant)
    await service.desk.do(service.store.withdraw, participant.code)
    # Exports are mended beside this answer; at the next start, should this process end now.
    mending = BackgroundTask(service.exporting.do, mend_exports, service.data)
    return JSONResponse(withdrawn_state(service.plan, participant), background=mending)


async def _check_begun(service: Service, participant: Participant, stage: int) -> None:
    """Refuses what belongs to a stage that is still to come; what is past may be said again."""
    position = (await _standpoint(service, participant)).position
    before_all = position.kind in {"consent", "demographics"}
    if before_all or (position.index is not None and position.index < stage):
        raise Refusal("not-now", "this stage has not begun: reload the page")


async def _leave_live(service: Service, participant: Participant) -> None:
    """Ends what is being played, so that nothing of it is stored any more."""
    connection = service.live.get(participant.code)
    if connection is not None:
        await connection.leave(1000, "participation ended")


async def _standpoint(service: Service, participant: Participant) -> Standpoint:
    return await service.desk.do(standpoint, service.plan, service.store, participant.code)
