"""What a Ray worker does: one group, from what the driver sent to the bytes of its files.

JAX reads the environment when it starts, so nothing may load it before the worker has set it: this
module imports what it needs late, and an errand can be unpacked without JAX.
"""

from __future__ import annotations

import os
import socket
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.compute.search.group_plan import GroupInputs


@dataclass(frozen=True)
class Errand:
    """A group on its way to a worker."""

    shared: tuple[Any]
    """The reference to `GroupInputs`. What stands alone, Ray unpacks before the worker begins."""
    seed: int
    round: int
    lambdas: tuple[float, ...]
    begun: Mapping[str, bytes]
    """Files that the group goes on from, by their path in the run directory."""
    directory: str
    """The driver's run directory, for messages."""
    environment: Mapping[str, str]
    places: tuple[str, ...]
    """Where the driver finds modules; a worker looks there last, say for the user's own task."""


@dataclass(frozen=True)
class Found:
    """A group that is done, on its way back."""

    files: Mapping[str, bytes]
    """Everything that it leaves, by its path in the run directory."""
    core_seconds: float
    """Processor time that it took [s]."""
    versions: Mapping[str, str]
    """Of the libraries that it ran with."""
    source: str
    """`source_hash` of the RIGID that it ran."""


def run_errand(errand: Errand) -> Found:
    """Runs a group in a directory of its own.

    Raises:
        UserError: A file that it goes on from is damaged, or this worker lacks a module.
    """
    os.environ.update(errand.environment)
    sys.path += [place for place in errand.places if place not in sys.path]
    from rigid.compute.run.clock import core_seconds

    spent = core_seconds()  # Loading JAX and the task counts.
    from rigid.compute.executors.group_files import read_group, write_group
    from rigid.compute.run.provenance import source_hash, versions
    from rigid.compute.search.group import run_group
    from rigid.compute.search.group_plan import GroupPlan

    plan = GroupPlan(errand.seed, errand.round, errand.lambdas)
    with tempfile.TemporaryDirectory(prefix="rigid-") as place:
        directory = Path(place)
        write_group(directory, plan, errand.begun)
        try:
            run_group(replace(_inputs(errand), directory=directory), plan)
        except UserError as error:
            raise UserError(str(error).replace(place, errand.directory)) from None
        files = read_group(directory, plan)
    return Found(files, core_seconds() - spent, versions(), source_hash())


def _inputs(errand: Errand) -> GroupInputs:
    """What all groups of the measurement share."""
    import ray
    from ray.exceptions import RaySystemError

    try:
        inputs: GroupInputs = ray.get(errand.shared[0])
    except RaySystemError as error:
        reason = str(error).strip().splitlines()[0].removeprefix("System error: ")
        raise UserError(
            f"the worker on {socket.gethostname()} cannot load the task and its robot ({reason}): "
            "install there what this machine has, the package of the task as well"
        ) from None
    return inputs
