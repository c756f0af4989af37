"""A program that runs beside RIGID, with pipes to it: started without a shell, and always ended."""

from __future__ import annotations

import os
import selectors
import shlex
import signal
import subprocess
import threading
import time
import weakref
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from rigid.cores import count_helper
from rigid.errors import UserError
from rigid.serving.environment import for_programs

_GRACE = 2.0
"""Seconds that a program has to end by itself, and again after it was asked to. Ours."""
_LAST_WORDS = 12
_LONGEST_WORDS = 400
"""Lines of standard error that are kept, and characters of each. Ours."""
_CHUNK = 1 << 16
_FORM = "write a program and its arguments, as 'exec:python3 my_program.py --fast'"


@dataclass(frozen=True)
class Command:
    """What a user wrote after `exec:`, and where."""

    text: str
    """The program and its arguments, quoted as for a shell."""
    folder: Path
    """Where it runs: worker processes may be elsewhere."""
    label: str = "the program"
    """Begins every message."""

    @property
    def words(self) -> list[str]:
        """The program and its arguments.

        Raises:
            UserError: There is no program, or a quote without its other half.
        """
        try:
            words = shlex.split(self.text)
        except ValueError as error:
            raise UserError(
                f"{self.label} has the command {self.text!r}: {error}: {_FORM}"
            ) from None
        if not words:
            raise UserError(f"{self.label} has the command {self.text!r}, which is empty: {_FORM}")
        return words


class ChildError(Exception):
    """The program did not do what it had to; the message says what, and goes on its name."""


class Child:
    """The running program. Every wait has a deadline; none waits for ever."""

    def __init__(self, command: Command) -> None:
        """Starts it.

        Raises:
            UserError: There is no such program, or it cannot be run.
        """
        words = command.words
        try:
            # A session of its own: Ctrl-C is RIGID's alone, and what it starts ends with it.
            self._process = subprocess.Popen(
                words, cwd=command.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE, start_new_session=True, env=for_programs(),
            )  # fmt: skip
        except OSError as error:
            where = command.folder if not command.folder.is_dir() else words[0]
            raise UserError(
                f"{command.label} cannot be started: {where}: {error.strerror}: {_FORM}"
            ) from None
        count_helper(self._process.pid)
        calls, answers, errors = (
            self._process.stdin, self._process.stdout, self._process.stderr,
        )  # fmt: skip
        assert calls is not None
        assert answers is not None
        assert errors is not None
        self._calls, self._answers = calls, answers
        for pipe in (calls, answers):
            os.set_blocking(pipe.fileno(), False)
        self._words: deque[str] = deque(maxlen=_LAST_WORDS)
        self._listener = threading.Thread(target=_listen, args=(errors, self._words), daemon=True)
        self._listener.start()
        self._buffer = bytearray()
        self._end = weakref.finalize(self, _end, self._process, self._listener)

    def write(self, data: bytes, seconds: float) -> None:
        """Sends all of `data`.

        Raises:
            ChildError: It ended, or did not read it in time.
        """
        rest, deadline = memoryview(data), time.monotonic() + seconds
        while rest:
            self._wait(self._calls, selectors.EVENT_WRITE, deadline, seconds)
            try:
                rest = rest[os.write(self._calls.fileno(), rest[:_CHUNK]) :]
            except BlockingIOError:  # Less room than a pipe promises at once.
                time.sleep(0.001)
            except BrokenPipeError:
                raise ChildError(self._how_it_ended()) from None

    def read(self, count: int, deadline: float, seconds: float) -> bytes:
        """The next `count` bytes that it wrote.

        Args:
            count: How many.
            deadline: On the clock of `time.monotonic`.
            seconds: How long that was; for the message.

        Raises:
            ChildError: It ended, or did not answer in time.
        """
        while len(self._buffer) < count:
            self._more(deadline, seconds)
        data = bytes(self._buffer[:count])
        del self._buffer[:count]
        return data

    def skip_until(self, mark: bytes, most: int, deadline: float, seconds: float) -> None:
        """Drops what comes before `mark`: what a program prints before it begins to serve.

        Raises:
            ChildError: It ended, did not answer in time, or wrote `most` bytes without it.
        """
        while (place := self._buffer.find(mark)) < 0:
            if len(self._buffer) > most:
                raise ChildError(
                    f"wrote {bytes(self._buffer[:60])!r} and more, which is no answer to RIGID"
                )
            self._more(deadline, seconds)
        del self._buffer[:place]

    def last_words(self) -> list[str]:
        """The last lines that it wrote to standard error."""
        return [line for line in self._words if line.strip()]

    def end(self) -> None:
        """Closes its input, which ends a program that serves; by force if it must be."""
        self._end()

    def kill(self) -> None:
        """Ends it at once, and what it started."""
        if self._process.poll() is None:
            _signal(self._process, signal.SIGKILL)
        self._end()

    def _more(self, deadline: float, seconds: float) -> None:
        self._wait(self._answers, selectors.EVENT_READ, deadline, seconds)
        data = os.read(self._answers.fileno(), _CHUNK)
        if not data:
            raise ChildError(self._how_it_ended())
        self._buffer += data

    def _wait(self, pipe: IO[bytes], event: int, deadline: float, seconds: float) -> None:
        with selectors.DefaultSelector() as selector:
            selector.register(pipe, event)
            if not selector.select(max(deadline - time.monotonic(), 0.0)):
                raise ChildError(f"did not answer within {seconds:g} s")

    def _how_it_ended(self) -> str:
        with suppress(subprocess.TimeoutExpired):
            code = self._process.wait(_GRACE)
            self._listener.join(_GRACE)  # Its last words may still be on their way.
            if code < 0:
                return f"was ended by signal {-code} ({signal.strsignal(-code)})"
            return f"ended (exit code {code}) before it answered"
        return "closed its standard input and output"


def _listen(errors: IO[bytes], words: deque[str]) -> None:
    """Keeps the last lines, so that a program that prints much is never held up."""
    with errors:
        while line := errors.readline(_LONGEST_WORDS):
            words.append(line.decode(errors="replace").rstrip())


def _end(process: subprocess.Popen[bytes], listener: threading.Thread) -> None:
    """Closes its pipes; waits, then asks, then kills."""
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with suppress(OSError):
                pipe.close()
    for sign in (None, signal.SIGTERM, signal.SIGKILL):
        if sign is not None:
            _signal(process, sign)
        with suppress(subprocess.TimeoutExpired):
            process.wait(_GRACE)
            break
    listener.join(_GRACE)


def _signal(process: subprocess.Popen[bytes], sign: signal.Signals) -> None:
    """To the program and all that it started; it has not been waited for, so its number is its."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, sign)
