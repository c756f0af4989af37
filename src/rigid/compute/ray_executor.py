"""Groups on the workers of a Ray cluster: Ray Core alone, and no file system in common.

The driver decides which group comes next and writes every file. A worker runs one group at a time,
in a directory of its own, and hands back the bytes of what it wrote; one that dies takes nothing
with it but the group that it was running.
"""

from __future__ import annotations

import logging
import os
import socket
from collections.abc import Generator, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from pickle import PicklingError
from typing import Any

from rigid.compute.driving import drive
from rigid.compute.group import GroupInputs, GroupPlan
from rigid.compute.group_files import read_begun, write_group
from rigid.compute.provenance import versions
from rigid.compute.ray_worker import Errand, Found, run_errand
from rigid.compute.seed_search import SeedSearch
from rigid.errors import UserError

MAX_RETRIES = 3
"""Times that Ray begins a group anew because its worker or node died; Ray's own default. A machine
that is taken away is bad luck, which seldom strikes one group four times; a group that brings down
whoever runs it, say for want of memory, has to come to an end."""
ASKED_FOR = 2
"""Groups that are asked for at a time, for each worker: one that runs, and one that waits so that
no worker idles while the driver prepares another robot. Ours."""
_PATIENCE = 5.0  # Seconds until a look at the clock and at the nodes, and for a TCP connection.


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
        _ray()
        if self.cpus < 1:
            raise UserError(f"cpus is {self.cpus}, but a group takes at least 1")
        if self.address is not None:
            _call_at(self.address)

    @contextmanager
    def workers(self) -> Iterator[RayWorkers]:
        """Joins the cluster, and leaves it at the end; a Ray of our own ends with it."""
        ray = _ray()
        joins = not ray.is_initialized()
        if joins:
            _join(self.address)
        try:
            yield RayWorkers(self.cpus)
        finally:
            if joins:
                ray.shutdown()


class RayWorkers:
    """The workers of the cluster that this process has joined."""

    def __init__(self, cpus: int) -> None:
        self._cpus = cpus
        task = _ray().remote(num_cpus=cpus, max_retries=MAX_RETRIES)
        self._run_errand = task(run_errand)
        self._shared: dict[Path, Any] = {}
        self._nodes = _nodes()
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
        )  # fmt: skip
        return self._run_errand.remote(errand)

    def next_done(self, waiting: Mapping[Any, tuple[SeedSearch, GroupPlan]]) -> Any:
        """A group that is done, or whose workers died too often; None when none is for a while."""
        ready, _ = _ray().wait(list(waiting), timeout=_PATIENCE)
        self._look_around(next(iter(waiting.values()))[0])
        return ready[0] if ready else None

    def collect(self, done: Any, search: SeedSearch, plan: GroupPlan) -> None:
        """Writes the files of a group into its run directory."""
        directory = search.inputs.directory
        found = _found(done, f"group {plan.name} of {directory}")
        write_group(directory, plan, found.files)
        search.clock.add(found.core_seconds)
        search.clock.keep()
        self._warn(search, found)
        assert search.take_finished(plan)

    def cancel(self, waiting: Mapping[Any, tuple[SeedSearch, GroupPlan]]) -> None:
        """Stops groups: the cluster may outlive an interrupted measurement."""
        for reference in waiting:
            _ray().cancel(reference, force=True)

    def _put(self, inputs: GroupInputs) -> Any:
        try:
            return _ray().put(replace(inputs, threads=self._cpus))
        except (TypeError, AttributeError, PicklingError) as error:
            reason = str(error).strip().splitlines()[0]
            raise UserError(
                f"task {inputs.task.name!r} and its robot cannot be sent to other machines "
                f"({reason}): use the executor local"
            ) from None

    def _look_around(self, search: SeedSearch) -> None:
        """Says when nodes came or went."""
        now = _nodes()
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


def _ray() -> Any:
    try:
        import ray
    except ImportError:
        raise UserError("the executor ray needs Ray: pip install 'rigid-frontier[ray]'") from None
    return ray


def _call_at(address: str) -> None:
    """Refuses an address at once, where Ray would try for half a minute."""
    host, _, port = address.rpartition(":")
    if not host or not port.isdigit():
        raise UserError(f"executor 'ray:{address}': write the address as ray:10.0.0.1:6379")
    try:
        socket.create_connection((host.strip("[]"), int(port)), timeout=_PATIENCE).close()
    except (OSError, OverflowError) as error:
        raise UserError(
            f"no Ray cluster answers at {address} ({error}): start one there with `ray start "
            "--head`, or name another address"
        ) from None


def _join(address: str | None) -> None:
    ray = _ray()
    quietly = {"log_to_driver": False, "logging_level": logging.ERROR}
    try:
        ray.init(address=address or "auto", **quietly)
    except (ConnectionError, RuntimeError, ValueError) as error:
        if address is not None:
            reason = str(error).strip().splitlines()[0]
            raise UserError(
                f"cannot join the Ray cluster at {address} ({reason}): run this command on one of "
                "its nodes, with the Python and Ray of the cluster"
            ) from None
        cores = len(os.sched_getaffinity(0))
        ray.init(address="local", num_cpus=cores, include_dashboard=False, **quietly)


def _nodes() -> dict[str, float]:
    """CPUs of each node that lives, by its id."""
    return {
        node["NodeID"]: node["Resources"].get("CPU", 0.0)
        for node in _ray().nodes()
        if node["Alive"]
    }


def _found(reference: Any, what: str) -> Found:
    """What a worker brought back, or why there is nothing."""
    from ray import exceptions

    try:
        found: Found = _ray().get(reference)
    except exceptions.RayTaskError as error:
        if isinstance(error.cause, UserError):
            raise UserError(str(error.cause)) from None
        raise
    except exceptions.RayError as error:
        reason = str(error).strip().splitlines()[0]
        raise UserError(
            f"{what} lost its worker {MAX_RETRIES + 1} times ({reason}): see that workers have "
            "memory enough; the same command goes on"
        ) from None
    return found


def _environment() -> dict[str, str]:
    """What JAX was told here, threads included, so that it computes alike there."""
    told = ("JAX_", "XLA_", "PJRT_")
    return {name: value for name, value in os.environ.items() if name.startswith(told)}


def _some(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
