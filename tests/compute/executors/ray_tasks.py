"""Toy tasks that know when a worker of a cluster begins a group, and what is to happen then."""

from __future__ import annotations

import os
import signal
import time
import uuid
from pathlib import Path

from tests.compute.executors.ray_cluster import NODE
from tests.compute.tiny import FilmedReach


class Watched(FilmedReach):
    """Notes on `desk` each group that a worker begins, with the node that it runs on."""

    def __init__(self, desk: Path) -> None:
        super().__init__()
        self.desk, self._begun = desk, False

    def make_world(self, batch, *, threads=0):
        node = os.environ.get(NODE)
        if node is not None and not self._begun:  # Each group has a task of its own.
            self._begun = True
            (self.desk / f"{node}.{uuid.uuid4()}").touch()
            self.begun(node)
        return super().make_world(batch, threads=threads)

    def begun(self, node: str) -> None:
        """A group begins."""

    def groups(self, node: str = "*") -> int:
        """Groups that were begun there, also those that came to nothing."""
        return len(list(self.desk.glob(f"{node}.*")))


class Doomed(Watched):
    """In its second group, the node `doomed` waits for its end; others wait until that is told."""

    def begun(self, node):
        if self.groups(node) < 2:
            return
        if node == "doomed":
            self.held.touch()
        while node == "doomed" or not self.told.exists():
            time.sleep(0.05)

    @property
    def held(self) -> Path:
        """Says that the node is in its second group."""
        return self.desk / "held"

    @property
    def told(self) -> Path:
        """Says that the driver knows of its end."""
        return self.desk / "told"


class Stuck(Watched):
    """No group ends."""

    def begun(self, node):
        del node
        while True:
            time.sleep(1)


class Deadly(Watched):
    """Kills every worker, as a system does that has no memory left."""

    def begun(self, node):
        del node
        os.kill(os.getpid(), signal.SIGKILL)
