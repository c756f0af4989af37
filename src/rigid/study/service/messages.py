"""What may be said to the service. Everything else is refused before anything looks at it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    RootModel,
    TypeAdapter,
    ValidationError,
)

from rigid.study.records import Device, Kind
from rigid.study.service.refusing import Refusal

BODY_BYTES = 64 * 1024
"""Largest body of a request."""
LIVE_BYTES = 8 * 1024
"""Largest live message."""

_Said = TypeVar("_Said", bound=BaseModel)
_Read = TypeVar("_Read")
_Count = Annotated[int, Field(ge=0, le=2**53 - 1)]  # As far as JavaScript counts.
_NO_NUL = r"^[^\x00]*$"
"""Files that hold one, such as an export's tables, are no text to many programs."""
_Short = Annotated[str, Field(max_length=100, pattern=_NO_NUL)]
_Metres = Annotated[float, Field(ge=-10, le=10)]
_Fact = Annotated[str, Field(max_length=300, pattern=_NO_NUL)] | bool | int | float | None


def _yes(value: bool) -> bool:
    if not value:
        raise ValueError("without it there is no taking part")
    return value


class Message(BaseModel):
    """Exactly these fields, of exactly these types, and no NaN."""

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)


class Consent(Message):
    """They agree to take part, and perhaps to sharing."""

    version: _Short
    agreed: Annotated[bool, AfterValidator(_yes)]  # `Literal[True]` would take 1 as well.
    sharing: bool = False


class Demographics(RootModel[dict[_Short, _Short | int | float | None]]):
    """Answers by the ids of `rigid.study.service.demographics`; null skips a question."""

    model_config = ConfigDict(frozen=True, strict=True, allow_inf_nan=False)


class Calibration(Message):
    """Body sizes measured in VR [m]; bounds of ours, beyond any adult's."""

    arm_length: Annotated[float, Field(ge=0.2, le=1.5)]
    seat_height: Annotated[float, Field(ge=0.0, le=2.5)]


class Watched(Message):
    """They saw a canonical episode to its end."""

    stage: _Count
    episode: _Short


class Responses(Message):
    """They answered a trial of a questionnaire."""

    stage: _Count
    trial: _Short
    responses: Annotated[dict[_Short, _Short | int | float], Field(min_length=1, max_length=16)]
    rt: Annotated[float, Field(ge=0, le=24 * 3600)]
    """How long it took [s]."""


class Stop(Message):
    """They end their participation; what they gave stays."""


class Withdraw(Message):
    """They end their participation, and what they gave is deleted."""

    confirm: Literal["withdraw"]


class Invite(Message):
    """Links are wanted."""

    role: _Short
    count: Annotated[int, Field(ge=1, le=200)] = 1
    external_id: Annotated[str, Field(min_length=1, max_length=200, pattern=_NO_NUL)] | None = None
    kind: Kind = "person"


class Begin(Message):
    """Begin the next episode."""

    type: Literal["start"]
    n: _Count
    device: Device
    about: Annotated[dict[_Short, _Fact], Field(max_length=30)] = {}
    """What the browser says of itself."""


class Target(Message):
    """Where the hand should go, world frame [m]."""

    type: Literal["target"]
    n: _Count
    step: _Count
    """The newest step that was seen when it was sent."""
    position: tuple[_Metres, _Metres, _Metres]


class Halt(Message):
    """Stop the running episode."""

    type: Literal["stop"]
    n: _Count


class Ping(Message):
    """How long is the way?"""

    type: Literal["ping"]
    n: _Count
    sent: Annotated[float, Field(ge=0, le=1e15)]


LiveMessage = Begin | Target | Halt | Ping
_live: TypeAdapter[LiveMessage] = TypeAdapter(Annotated[LiveMessage, Field(discriminator="type")])


def read_live(text: str) -> LiveMessage:
    """A live message.

    Raises:
        Refusal: As `read_message`.
    """
    return _read(_live.validate_json, text)


def read_message(kind: type[_Said], text: bytes | str) -> _Said:
    """A message of JSON.

    Raises:
        Refusal: It is no JSON, or not what `kind` says.

    Example:
        >>> read_message(Withdraw, '{"confirm": "withdraw"}')
        Withdraw(confirm='withdraw')
        >>> read_message(Withdraw, '{"confirm": true}')
        Traceback (most recent call last):
        rigid.study.service.refusing.Refusal: confirm: Input should be 'withdraw'
    """
    return _read(kind.model_validate_json, text)


def _read(read: Callable[[bytes | str], _Read], text: bytes | str) -> _Read:
    try:
        return read(text)
    except ValidationError as error:
        # Nothing of the message is said back: it may be anything.
        first = error.errors(include_url=False, include_input=False, include_context=False)[0]
        if first["type"] == "json_invalid":
            raise Refusal("malformed", "this is no JSON") from None
        place = ".".join(str(part) for part in first["loc"])[:100]
        said = first["msg"] if len(first["msg"]) < 200 else "not what is expected"
        raise Refusal("invalid", f"{place}: {said}" if place else said) from None
