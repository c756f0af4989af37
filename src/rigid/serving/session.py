"""A conversation with a program that serves: handshake, calls, and what to say when it fails."""

from __future__ import annotations

import itertools
import os
import threading
import time
import weakref
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Generic, Literal, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from rigid.errors import UserError
from rigid.serving.child import Child, ChildError, Command
from rigid.serving.rigid_serve import MAGIC, PROTOCOL, Frame, FrameError, pack, read_frame

START_SECONDS = 300.0
"""How long a program may take until it serves: heavy imports, a container that starts. Ours."""
_PRINTED = 1 << 16
"""Bytes that a program may print before it serves. Ours."""
_HAND_OUT = "write that file again with `rigid export --serve rigid_serve.py`"

Size = Annotated[int, Field(ge=1, le=1_000_000)]
Counts = Annotated[tuple[Annotated[int, Field(ge=2, le=1_000_000)], ...], Field(max_length=1000)]


class Promise(BaseModel):
    """What every program says of itself in the handshake."""

    model_config = ConfigDict(frozen=True)

    serves: Literal["policy", "task"]
    fingerprint: Annotated[str, Field(min_length=1, max_length=128)]
    timeout: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    """Seconds to wait for an answer."""


_Promise = TypeVar("_Promise", bound=Promise)


class Session(Generic[_Promise]):
    """A program that has said what it serves."""

    def __init__(
        self, command: Command, kind: type[_Promise], *, seconds: float = START_SECONDS
    ) -> None:
        """Starts the program and asks what it serves.

        Args:
            command: The program.
            kind: What is expected of it.
            seconds: How long it may take to start.

        Raises:
            UserError: It cannot be started, ends, hangs, or answers something else.
        """
        self._command, self._seconds, self._answered = command, seconds, False
        self._numbers, self._done_with = itertools.count(), list[int]()
        self.broken = False
        self._child = Child(command)
        self.send("hello", {"protocol": PROTOCOL})
        self.promise = self._read_promise(self.receive("hello").fields, kind)
        self._seconds = self.promise.timeout

    def send(
        self,
        kind: str,
        fields: Mapping[str, Any] | None = None,
        arrays: Mapping[str, np.ndarray] | None = None,
    ) -> None:
        """Sends a call; `receive` waits for what it comes to.

        Raises:
            UserError: The program is no longer there, or does not listen.
        """
        done_with = self._done_with[:]  # A collector may add to it at any moment.
        del self._done_with[: len(done_with)]
        data = pack(kind, {**(fields or {}), "done_with": done_with}, arrays)
        try:
            self._child.write(data, self._seconds)
        except ChildError as error:
            raise self.failure(str(error)) from None
        except BaseException:
            self.kill()
            raise

    def receive(self, kind: str) -> Frame:
        """Waits for an answer.

        Raises:
            UserError: The program ended, hangs, or answered what is no frame of this kind.
        """
        try:
            while (frame := self._next()).kind == "busy":
                pass
        except (ChildError, FrameError) as error:
            raise self.failure(_as_predicate(error)) from None
        except BaseException:  # Interrupted: the answer would be taken for that to the next call.
            self.kill()
            raise
        if frame.kind != kind:
            raise self.failure(f"answered {frame.kind[:40]!r} where {kind!r} was due")
        return frame

    def number(self, holder: object) -> int:
        """A number under which the program keeps something, for as long as `holder` is held."""
        number = next(self._numbers)
        weakref.finalize(holder, self._done_with.append, number).atexit = False
        return number

    def failure(self, what: str, cure: str | None = None) -> UserError:
        """Ends the program, and says what it did."""
        self.kill()
        words = self._child.last_words()
        said = "".join(f"\n  {line}" for line in words)
        told = f"; the last lines that it wrote to standard error:{said}" if words else ""
        cure = cure or self._cure(what)
        return UserError(f"{self._command.label} {what}: {cure}{told}")

    def close(self) -> None:
        """Ends the program, which may end in its own way."""
        self.broken = True
        self._child.end()

    def kill(self) -> None:
        """Ends the program at once."""
        self.broken = True
        self._child.kill()

    def _next(self) -> Frame:
        deadline = time.monotonic() + self._seconds
        if not self._answered:
            self._child.skip_until(MAGIC, _PRINTED, deadline, self._seconds)
            self._answered = True
        return read_frame(lambda count: self._child.read(count, deadline, self._seconds))

    def _read_promise(self, fields: Mapping[str, Any], kind: type[_Promise]) -> _Promise:
        if (theirs := fields.get("protocol")) != PROTOCOL:
            raise self.failure(
                f"speaks version {theirs!r} of the protocol of rigid_serve.py, but this RIGID "
                f"speaks {PROTOCOL}", _HAND_OUT,
            )  # fmt: skip
        try:
            return kind.model_validate(dict(fields))
        except ValidationError as error:
            first = error.errors()[0]
            place = ".".join(str(part) for part in first["loc"])
            if place == "serves":
                raise self.failure(
                    f"serves a {fields.get('serves')}, which is not what it was named for",
                    "--task takes programs that call serve_task, --robot and --human those that "
                    "call serve_policy",
                ) from None
            raise self.failure(f"said {place}: {first['msg']}", "mend what it serves") from None

    def _cure(self, what: str) -> str:
        if "did not answer within" in what and self._answered:
            return "mend it, or let it serve with a larger `timeout`"
        if not self._answered:
            return (
                "run it by itself to see why; a program for RIGID calls rigid_serve.serve_policy "
                "or serve_task (docs/exec.md)"
            )
        return "mend the program, and try again"


def opened_again(command: Command, promise: _Promise) -> Session[_Promise]:
    """The same program in another process.

    Raises:
        UserError: It cannot be started, or serves something else by now.
    """
    session = Session(command, type(promise))
    if session.promise != promise:
        raise session.failure(
            "serves something else than before",
            "its files were changed, or differ on this machine: measure again",
        )
    return session


def _as_predicate(error: Exception) -> str:
    return str(error) if isinstance(error, ChildError) else f"sent what is no answer: {error}"


_Thing = TypeVar("_Thing")


class PerProcess(Generic[_Thing]):
    """Something that each process opens for itself, when it first needs it.

    Copies that travel to other processes arrive closed; a process that was forked opens its own.
    """

    def __init__(self, opened: _Thing | None = None) -> None:
        self._opened, self._owner, self._lock = opened, os.getpid(), threading.Lock()

    def get(
        self, open_it: Callable[[], _Thing], *, broken: Callable[[_Thing], bool] | None = None
    ) -> _Thing:
        """It, opened by `open_it` if it is not open here, or is `broken`."""
        with self._lock:
            found = self._opened if self._owner == os.getpid() else None
            if found is None or (broken is not None and broken(found)):
                found = open_it()
                self._opened, self._owner = found, os.getpid()
            return found

    def __reduce__(self) -> tuple[Any, ...]:
        return PerProcess, ()
