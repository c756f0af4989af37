"""A Ray cluster on this machine: nodes are started as their users start them, and really killed."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import ray

NODE = "RIGID_TEST_NODE"
"""Says in every process of a node which node that is."""
_SMALL = ("--num-cpus=1", f"--object-store-memory={80_000_000}", "--disable-usage-stats")
_WATCHFUL = {"RAY_health_check_period_ms": "1000", "RAY_health_check_failure_threshold": "3"}
"""A dead node is noticed after some 3 s; Ray itself takes 15 s and more."""
_PATIENCE = 120.0  # Seconds until a node counts as hung; a shared machine may be slow.


class RayCluster:
    """A head node and more, of one CPU each, on free ports and in a folder of their own."""

    def __init__(self) -> None:
        # Not pytest's: sockets lie below it, and their paths may have 107 characters.
        self.folder = Path(tempfile.mkdtemp(prefix="ray-"))
        self._sessions: dict[str, int] = {}
        self._start(
            "head", "--head", "--port=0", f"--temp-dir={self.folder}", "--include-dashboard=false"
        )
        self.address = (self.folder / "ray_current_cluster").read_text()

    def add_node(self, name: str) -> None:
        """Starts one more node, whose processes find `name` in their environment."""
        self._start(name, f"--address={self.address}")

    @contextmanager
    def joined(self) -> Iterator[str]:
        """Joins this process, as the program of a user may; gives the address."""
        ray.init(address=self.address, log_to_driver=False)
        try:
            yield self.address
        finally:
            ray.shutdown()

    def kill_node(self, name: str) -> None:
        """Takes all processes of a node, as a power cut does."""
        session = self._sessions.pop(name)
        while pids := _processes_of(session):
            for pid in pids:
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
            time.sleep(0.05)

    def stop(self) -> None:
        """Takes every node, and what they left."""
        for name in list(self._sessions):
            self.kill_node(name)
        shutil.rmtree(self.folder, ignore_errors=True)

    def _start(self, name: str, *options: str) -> None:
        log = self.folder / f"{name}.log"
        with log.open("w") as output:
            starting = subprocess.Popen(
                [sys.executable, "-m", "ray.scripts.scripts", "start", *options, *_SMALL],
                env={**os.environ, **_WATCHFUL, NODE: name},
                stdout=output, stderr=subprocess.STDOUT,
                start_new_session=True,  # By which all that it leaves running is found.
            )  # fmt: skip
            self._sessions[name] = starting.pid
            code = starting.wait(timeout=_PATIENCE)
        assert code == 0, log.read_text()


def _processes_of(session: int) -> list[int]:
    """Those of a session that live, by number."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # It has just ended.
            # After the name, which may hold anything: state, parent, group, session.
            state, _, _, of = stat.read_text().rpartition(")")[2].split()[:4]
            if int(of) == session and state != "Z":
                found.append(int(stat.parent.name))
    return found
