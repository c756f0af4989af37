"""Groups on the workers of a Ray cluster: Ray Core alone, and no file system in common.

The driver decides which group comes next and writes every file. A worker runs one group at a time,
in a directory of its own, and hands back the bytes of what it wrote; one that dies takes nothing
with it but the group that it was running.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Generator, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rigid.compute.executors.driving import drive
from rigid.compute.executors.group_files import read_begun, write_group
from rigid.compute.executors.process_worker import progress_file
from rigid.compute.executors.ray_joining import (
    call_at,
    first_line,
    import_ray,
    joined,
    living_nodes,
)
from rigid.compute.executors.ray_worker import Errand, Found, run_errand
from rigid.compute.run.provenance import source_hash, versions
from rigid.compute.search.group_plan import GroupInputs, GroupPlan, all_steps, begun_steps
from rigid.compute.search.seed_search import SeedSearch
from rigid.errors import UserError

MAX_RETRIES = 3
"""Times that Ray begins a group anew because its worker or node died; Ray's own default. A machine
that is taken away is bad luck, which seldom strikes one group four times; a group that brings down
whoever runs it, say for want of memory, has to come to an end."""
ASKED_FOR = 2
"""Groups that are asked for at a time, for each worker: one that runs, and one that waits so that
no worker idles while the driver prepares another robot. Ours."""
_PATIENCE = 5.0  # Seconds until the next look at the clock and at the nodes.


@dataclass(frozen=True)
class RayExecutor:
    """A Ray cluster.

    A Ray that the program has already joined is used as it is, and stays.

    Raises:
        UserError: Ray is not installed, `cpus` is below 1, or nobody answers at the address.
    """

    address: str | None = None
    """HOST:PORT of the head node; None: the Ray that runs on this machine, else one of our own."""
    cpus: int = 1
    """What each group asks for, and the threads of its physics. One does the most work for the
    time of the machines: half of a group's work does not divide among threads."""

    def __post_init__(self) -> None:
        import_ray()
        if self.cpus < 1:
            raise UserError(f"cpus is {self.cpus}, but a group takes at least 1")
        if self.address is not None:
            call_at(self.address)

    @contextmanager
    def workers(self) -> Iterator[RayWorkers]:
        """Joins the cluster, and leaves it at the end; a Ray of our own ends with it."""
        with joined(self.address):
            yield RayWorkers(self.cpus)


class RayWorkers:
    """The workers of the cluster that this process has joined."""

    def __init__(self, cpus: int) -> None:
        self._cpus = cpus
        self._ray = import_ray()
        task = self._ray.remote(num_cpus=cpus, max_retries=MAX_RETRIES)
        self._run_errand = task(run_errand)
        self._shared: dict[Path, Any] = {}
        self._nodes = living_nodes()
        self._warned: set[str] = set()

    @property
    def count(self) -> int:
        """Groups that can run at a time; 1 where a node is still to join."""
        return max(self._places, 1)

    @property
    def description(self) -> str:
        """How many workers on how many nodes."""
        if not self._places:
            return f"Ray: no node has {_some(self._cpus, 'free CPU')} yet, so groups wait for one"
        places, nodes = _some(self._places, "worker"), _some(len(self._nodes), "node")
        return f"Ray: {places} on {nodes}, {_some(self._cpus, 'CPU')} for each"

    @property
    def _places(self) -> int:
        return sum(int(cpus // self._cpus) for cpus in self._nodes.values())

    def run(self, searches: Iterable[SeedSearch]) -> Generator[SeedSearch, None, None]:
        """Runs searches side by side."""
        return drive(searches, self)

    @property
    def asked_for(self) -> int:
        """One group for each worker to run, and one to wait."""
        return ASKED_FOR * self.count

    def send(self, search: SeedSearch, plan: GroupPlan) -> Any:
        """Asks Ray for a group."""
        directory = search.inputs.directory
        if directory not in self._shared:
            self._shared[directory] = self._put(search.inputs)
        errand = Errand(
            shared=(self._shared[directory],),
            seed=plan.seed, round=plan.round, lambdas=plan.lambdas,
            begun=read_begun(directory, plan),
            directory=str(directory),
            environment=_environment(),
            places=tuple(sys.path),
        )  # fmt: skip
        return self._run_errand.remote(errand)

    def next_done(self, waiting: Mapping[Any, tuple[SeedSearch, GroupPlan]]) -> Any:
        """A group that is done, or whose workers died too often; None when none is for a while."""
        ready, _ = self._ray.wait(list(waiting), timeout=_PATIENCE)
        self._look_around(next(iter(waiting.values()))[0])
        self._let_go(waiting)
        return ready[0] if ready else None

    def collect(self, done: Any, search: SeedSearch, plan: GroupPlan) -> None:
        """Writes the files of a group into its run directory."""
        directory = search.inputs.directory
        begun = begun_steps(search.inputs, plan)  # Its worker went on from there.
        found = _found(done, f"group {plan.name} of {directory}")
        refuse_other_rigid(found.source, source_hash())
        write_group(directory, plan, found.files)
        progress_file(directory, plan).unlink(missing_ok=True)  # Of a process that began it.
        search.clock.add(found.core_seconds)
        search.clock.keep()
        self._warn(search, found)
        search.take_stored(plan)
        search.advance(all_steps(search.inputs, plan) - begun)

    def cancel(self, waiting: Mapping[Any, tuple[SeedSearch, GroupPlan]]) -> None:
        """Stops groups: the cluster may outlive an interrupted measurement."""
        for reference in waiting:
            self._ray.cancel(reference, force=True)

    def _put(self, inputs: GroupInputs) -> Any:
        try:
            return self._ray.put(replace(inputs, threads=self._cpus))
        except self._ray.exceptions.RayError:
            raise  # A cluster's trouble, no object's.
        except Exception as error:  # noqa: BLE001 - Whatever an object of strangers says when it is pickled.
            raise UserError(
                f"task {inputs.task.name!r} and its robot cannot be sent to other machines "
                f"({first_line(error)}): use the executor local"
            ) from None

    def _let_go(self, waiting: Mapping[Any, tuple[SeedSearch, GroupPlan]]) -> None:
        """Frees what robots shared that have no group left; a fleet would fill the memory."""
        needed = {search.inputs.directory for search, _ in waiting.values()}
        for directory in self._shared.keys() - needed:
            del self._shared[directory]

    def _look_around(self, search: SeedSearch) -> None:
        """Says when nodes came or went."""
        now = living_nodes()
        if now != self._nodes:
            self._nodes = now
            search.listener.say(self.description)

    def _warn(self, search: SeedSearch, found: Found) -> None:
        """Says, once, that a worker has other libraries than the driver."""
        for name, here in versions().items():
            there = found.versions.get(name)
            if there != here and name not in self._warned:
                self._warned.add(name)
                search.listener.say(
                    f"a worker has {name} {there}, here it is {here}: its numbers may differ in "
                    "the last digits"
                )


def refuse_other_rigid(there: str, here: str) -> None:
    """Raises `UserError` unless worker and driver run the same RIGID, by their `source_hash`."""
    if there != here:
        raise UserError(
            f"a worker runs another RIGID (source {there[:8]}, here {here[:8]}), whose numbers are "
            "not these: install the same on every node; the same command goes on"
        )


def _found(reference: Any, what: str) -> Found:
    """What a worker brought back, or why there is nothing."""
    from ray import exceptions

    try:
        found: Found = import_ray().get(reference)
    except exceptions.RayTaskError as error:
        if isinstance(error.cause, UserError):
            raise UserError(str(error.cause)) from None
        raise
    except exceptions.RayError as error:
        raise UserError(
            f"{what} lost its workers ({first_line(error)}): see that they have memory enough; "
            "the same command goes on"
        ) from None
    return found


def _environment() -> dict[str, str]:
    """What JAX was told here, threads included, so that it computes alike there."""
    told = ("JAX_", "XLA_", "PJRT_")
    return {name: value for name, value in os.environ.items() if name.startswith(told)}


def _some(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
