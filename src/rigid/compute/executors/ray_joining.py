"""Joining a Ray cluster, or starting one on this machine."""

from __future__ import annotations

import logging
import os
import socket
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from rigid.cores import cores
from rigid.errors import UserError

_PATIENCE = 5.0  # Seconds for a TCP connection.
_QUIETLY = {"log_to_driver": False, "logging_level": logging.ERROR}
_AUTH_MODE = "RAY_AUTH_MODE"


def import_ray() -> Any:
    """The package.

    Raises:
        UserError: It is not installed.
    """
    try:
        import ray
    except ImportError:
        raise UserError("the executor ray needs Ray: pip install 'rigid-frontier[ray]'") from None
    return ray


def call_at(address: str) -> None:
    """Refuses an address at once, where Ray would try for half a minute.

    Raises:
        UserError: It is not HOST:PORT, or nobody answers there.
    """
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


@contextmanager
def joined(address: str | None) -> Iterator[None]:
    """Joins a cluster, and leaves it at the end; one that the program has joined before stays.

    Args:
        address: HOST:PORT; None joins the one that RAY_ADDRESS names or that runs on this machine,
            else starts one, which ends with the block.

    Raises:
        UserError: It cannot be joined.
    """
    ray = import_ray()
    if ray.is_initialized():
        yield
        return
    if address is None and ":" in os.environ.get("RAY_ADDRESS", ""):
        address = os.environ["RAY_ADDRESS"]  # Named by the user: that one or none.
        call_at(address)
    before = os.environ.get(_AUTH_MODE)
    _join(ray, address)
    try:
        yield
    finally:
        ray.shutdown()
        if before is None:  # Ray sets it for its own, and could join no other any more.
            os.environ.pop(_AUTH_MODE, None)


def living_nodes() -> dict[str, float]:
    """CPUs of each node of the joined cluster that lives, by its id."""
    return {
        node["NodeID"]: node["Resources"].get("CPU", 0.0)
        for node in import_ray().nodes()
        if node["Alive"]
    }


def first_line(error: BaseException) -> str:
    """What Ray and pickle say before they go into detail."""
    return (str(error).strip() or type(error).__name__).splitlines()[0]


def _join(ray: Any, address: str | None) -> None:
    from ray.exceptions import AuthenticationError

    try:
        ray.init(address=address or "auto", **_QUIETLY)
    except (ConnectionError, RuntimeError, ValueError, AuthenticationError) as error:
        if address is None:
            _start_own(ray)
            return
        raise UserError(
            f"cannot join the Ray cluster at {address} ({first_line(error)}): run this command on "
            "one of its nodes, with the Python and Ray of the cluster, and with its RAY_AUTH_MODE "
            "where it asks for a token"
        ) from None


def _start_own(ray: Any) -> None:
    """A Ray on this machine that asks nobody outside."""
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    with warnings.catch_warnings():
        # JAX warns of every fork. Those of Ray become other programs before they touch a lock.
        warnings.filterwarnings("ignore", r"os\.fork\(\) was called", RuntimeWarning)
        ray.init(address="local", num_cpus=len(cores()), include_dashboard=False, **_QUIETLY)
