"""A real server in a process of its own, which can be killed and started again."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

from rigid.errors import UserError

COMMAND = (sys.executable, "-m", "rigid", "study", "serve")
_START_SECONDS = 120.0
"""Longest that a server may take to start: a cold machine loads JAX and makes replays."""


class StudyServer:
    """`rigid study serve` on a free port of this machine; use as a context manager."""

    def __init__(
        self, data: Path, *options: str, command: Sequence[str] = COMMAND, port: int | None = None
    ) -> None:
        """Starts it, and waits until it answers.

        Raises:
            UserError: It ended, or does not answer.
        """
        self.data, self.port = data, port or _free_port()
        self.address = f"http://127.0.0.1:{self.port}"
        self.admin_token = ""
        self.log = data.with_name(data.name + ".log")
        self._command = [*command, "--data", str(data), "--port", str(self.port), *options]
        self._processor_before = 0.0
        self._start()

    def _start(self) -> None:
        with self.log.open("ab") as log:
            self._process = subprocess.Popen(
                self._command, stdout=subprocess.PIPE, stderr=log, text=True,
                env={**os.environ, "PYTHONUNBUFFERED": "1"},
            )  # fmt: skip
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.startswith("admin token: "):
                self.admin_token = line.split()[-1]
            if line.startswith("kept in "):
                break
        self._wait_for_answer()

    def _wait_for_answer(self) -> None:
        until = time.monotonic() + _START_SECONDS
        while time.monotonic() < until and self._process.poll() is None:
            try:
                with urllib.request.urlopen(self.address, timeout=5):  # noqa: S310 - our own address.
                    return
            except OSError:
                time.sleep(0.05)
        raise UserError(f"the server did not start: see {self.log}")

    def kill(self) -> None:
        """Signal 9: no time to say anything."""
        self._processor_before += self._own_processor_seconds()
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()

    def restart(self) -> None:
        """The same command, after `kill`."""
        self._start()

    @property
    def alive(self) -> bool:
        """Whether it runs."""
        return self._process.poll() is None

    @property
    def processor_seconds(self) -> float:
        """Of all its processes so far."""
        return self._processor_before + self._own_processor_seconds()

    def _own_processor_seconds(self) -> float:
        fields = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def invite(self, role: str, count: int) -> list[str]:
        """Tokens of new scripted participants."""
        said = {"role": role, "count": count, "kind": "scripted"}
        found = self.admin("invite", said)
        return [link["path"].removeprefix("/p/") for link in found["links"]]

    def admin(self, what: str, said: dict[str, Any] | None = None) -> dict[str, Any]:
        """Asks the admin's side."""
        request = urllib.request.Request(  # noqa: S310 - our own address.
            f"{self.address}/admin/api/{what}",
            data=None if said is None else json.dumps(said).encode(),
            headers={
                "Authorization": f"Bearer {self.admin_token}",
                "Content-Type": "application/json",
            },
        )
        with urllib.request.urlopen(request, timeout=30) as answer:  # noqa: S310 - as above.
            found: dict[str, Any] = json.load(answer)
        return found

    def stop(self) -> int:
        """Ends it as Ctrl-C does; returns its exit code."""
        if self.alive:
            self._process.send_signal(signal.SIGINT)
        return self._process.wait(timeout=60)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
        if self._process.stdout is not None:
            self._process.stdout.close()


def _free_port() -> int:
    with socket.socket() as opened:
        opened.bind(("127.0.0.1", 0))
        port: int = opened.getsockname()[1]
    return port
