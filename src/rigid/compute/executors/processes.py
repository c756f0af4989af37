"""Groups in processes of this machine, one for each core.

Half of a group's work does not divide among threads. Two processes with a core each therefore do
more than one process with two (docs/scaling.md), and their groups end in the same numbers.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Generator, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import resource_tracker
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rigid.compute.executors.driving import drive
from rigid.compute.executors.process_worker import (
    Progress,
    leave_errand,
    progress_file,
    read_progress,
    settle,
    work,
)
from rigid.compute.search.group_plan import GroupPlan
from rigid.compute.search.seed_search import SeedSearch
from rigid.cores import cores
from rigid.errors import UserError
from rigid.interrupts import interrupts_held

_PATIENCE = 0.5  # Seconds until the next look at what workers say.


def can_be_sent(thing: Any) -> bool:
    """Whether another process can be given it."""
    import cloudpickle

    try:
        cloudpickle.dumps(thing)
    except Exception:  # noqa: BLE001 - Whatever a stranger's object says when it is pickled.
        return False
    return True


@dataclass(frozen=True)
class Processes:
    """So many worker processes; they start with the first group, and end with the measurement."""

    count: int

    @contextmanager
    def workers(self) -> Iterator[ProcessWorkers]:
        """Starts them, and ends them also in the middle of a group."""
        from loky import ProcessPoolExecutor

        with TemporaryDirectory(prefix="rigid-") as desk:
            settling = (Path(desk), cores()[: self.count])
            with interrupts_held():
                pool = ProcessPoolExecutor(self.count, initializer=settle, initargs=settling)
            try:
                yield ProcessWorkers(self.count, pool, Path(desk))
            finally:
                pool.shutdown(kill_workers=True)


@contextmanager
def _starting() -> Iterator[None]:
    """Keeps Ctrl-C until the end of the block, and from processes that start in it until `settle`.

    The terminal sends it to all of them, and who still loads modules would answer with a traceback.
    So it is with SIGTERM, which a scheduler sends to all: the driver is who ends its workers.
    """
    resource_tracker.ensure_running()  # With a first process, it would let signals through again.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        with interrupts_held():  # Threads of JAX let through what this one does not.
            yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _killed_is_told(search: SeedSearch, plan: GroupPlan) -> Iterator[None]:
    """Turns the loss of a process into a message.

    Raises:
        UserError: One was killed; the others end with it.
    """
    from loky.process_executor import TerminatedWorkerError

    try:
        yield
    except TerminatedWorkerError:
        raise UserError(
            f"the process of group {plan.name} of {search.inputs.directory} was killed, perhaps "
            "for want of memory: the same command goes on"
        ) from None


class ProcessWorkers:
    """Processes that are ready for groups."""

    def __init__(self, count: int, pool: Any, desk: Path) -> None:
        self.count, self._pool, self._desk = count, pool, desk
        self.description: str | None = f"{count} processes, a core for each"
        self._heard: dict[Future[None], Progress] = {}

    def run(self, searches: Iterable[SeedSearch]) -> Generator[SeedSearch, None, None]:
        """Runs searches side by side."""
        return drive(searches, self)

    @property
    def asked_for(self) -> int:
        """One more than there are processes, so that none idles while a robot is prepared."""
        return self.count + 1

    def send(self, search: SeedSearch, plan: GroupPlan) -> Future[None]:
        """Hands a group to the next free process."""
        progress_file(search.inputs.directory, plan).unlink(missing_ok=True)  # Of an earlier one.
        errand = leave_errand(self._desk, search.inputs, plan)
        with _starting(), _killed_is_told(search, plan):
            future: Future[None] = self._pool.submit(work, errand, os.getpid())
        self._heard[future] = Progress()
        return future

    def next_done(
        self, waiting: Mapping[Future[None], tuple[SeedSearch, GroupPlan]]
    ) -> Future[None] | None:
        """A group that is done; None when none is for a while."""
        done, _ = wait(waiting, timeout=_PATIENCE, return_when=FIRST_COMPLETED)
        for future, (search, plan) in waiting.items():
            self._hear(future, search, plan)
        return next(iter(done), None)

    def collect(self, done: Future[None], search: SeedSearch, plan: GroupPlan) -> None:
        """Takes its points; its files are where they belong."""
        with _killed_is_told(search, plan):
            done.result()
        directory = search.inputs.directory
        self._hear(done, search, plan)
        progress_file(directory, plan).unlink(missing_ok=True)
        search.take_stored(plan)
        search.clock.keep()

    def cancel(self, waiting: Mapping[Future[None], Any]) -> None:
        """The processes end with the pool."""

    def _hear(self, future: Future[None], search: SeedSearch, plan: GroupPlan) -> None:
        """Passes on what a worker did since it was last heard."""
        before, now = self._heard[future], read_progress(search.inputs.directory, plan)
        self._heard[future] = now
        search.clock.add(now.core_seconds - before.core_seconds)
        if now.env_steps > before.env_steps:
            search.advance(now.env_steps - before.env_steps)
