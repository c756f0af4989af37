"""What a worker process of this machine does: one group after the other, on a core of its own.

It speaks through small files, which whoever kills it leaves whole; a queue would be left locked.
Nothing here may start JAX before the worker has its core: JAX counts cores when it starts.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from rigid.files import write_atomically

if TYPE_CHECKING:
    from rigid.compute.search.group_plan import GroupInputs, GroupPlan


@dataclass(frozen=True)
class Progress:
    """How far a worker is with a group."""

    env_steps: int = 0
    core_seconds: float = 0.0
    """Processor time that it took so far [s]."""


def settle(desk: Path, cores: Sequence[int]) -> None:
    """Takes the next free core, where the system allows it, and leaves signals to the driver.

    Args:
        desk: Folder in which workers mark what they took.
        cores: Those that are to be had.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Heard and not ignored: what a worker starts would ignore it too, and could not be ended.
    signal.signal(signal.SIGTERM, lambda *_: None)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM})
    if not hasattr(os, "sched_setaffinity"):
        return
    for core in cores:
        try:
            (desk / str(core)).touch(exist_ok=False)
        except FileExistsError:
            continue
        os.sched_setaffinity(0, {core})
        return


def leave_errand(desk: Path, inputs: GroupInputs, plan: GroupPlan) -> Path:
    """Writes down what a worker is to do: a pipe that nobody empties would hold up who fills it.

    Args:
        desk: Folder that belongs to this measurement alone.
        inputs: What all groups of the measurement share.
        plan: The group.
    """
    import cloudpickle

    handle, name = tempfile.mkstemp(dir=desk)
    os.close(handle)
    errand = Path(name)
    errand.write_bytes(cloudpickle.dumps((inputs, plan)))
    return errand


def work(errand: Path, driver: int) -> None:
    """Runs a group in its run directory, where the driver finds it.

    Args:
        errand: What was left by `leave_errand`; it is gone afterwards.
        driver: Process that asked for it; without it nobody holds the run directory any more, and
            this process ends at once.
    """
    from rigid.compute.run.clock import core_seconds
    from rigid.compute.search.group import run_group

    inputs, plan = _take(errand)
    begun, place, done = core_seconds(), progress_file(inputs.directory, plan), 0
    place.parent.mkdir(exist_ok=True)

    def advance(env_steps: int) -> None:
        nonlocal done
        if os.getppid() != driver:
            os._exit(1)
        done += env_steps
        write_atomically(place, json.dumps(asdict(Progress(done, core_seconds() - begun))).encode())

    run_group(replace(inputs, threads=1), plan, advance=advance)
    advance(0)


def _take(errand: Path) -> tuple[GroupInputs, GroupPlan]:
    with errand.open("rb") as file:
        inputs, plan = pickle.load(file)  # noqa: S301  Our own driver's, from a folder that only its user can enter; a task's functions have no other form.
    errand.unlink()
    return inputs, plan


def progress_file(directory: Path, plan: GroupPlan) -> Path:
    """Where a worker says how far it is; gone once the group is done."""
    return directory / "groups" / f"{plan.name}.progress"


def read_progress(directory: Path, plan: GroupPlan) -> Progress:
    """What a worker said last."""
    place = progress_file(directory, plan)
    return Progress(**json.loads(place.read_bytes())) if place.exists() else Progress()
