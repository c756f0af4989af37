"""Where the groups of measurements run: in this process, or on the workers of a Ray cluster.

An executor drives the searches of seeds (`rigid.compute.search.seed_search`) and leaves the same
files in the same run directories, wherever it does the work.
"""

from __future__ import annotations

import difflib
from collections.abc import Generator, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any, Protocol, runtime_checkable

from rigid.compute.search.group import run_group
from rigid.compute.search.seed_search import SeedSearch
from rigid.errors import UserError

_KINDS = "local, ray or ray:HOST:PORT"


@runtime_checkable
class Workers(Protocol):
    """Those who run groups, ready to be given work."""

    @property
    def count(self) -> int:
        """Groups that can run at a time."""
        ...

    @property
    def description(self) -> str | None:
        """Who they are, to be told to the user; None where there is nothing to tell."""
        ...

    def run(self, searches: Iterable[SeedSearch]) -> Generator[SeedSearch, None, None]:
        """Runs searches to their ends.

        Args:
            searches: Taken one by one, no sooner than there is a worker for them: the next one may
                be of another robot, and cost its preparation.

        Yields:
            Each search when its last group is done, in whatever order they end. What its groups
            found lies in its run directory.

        Raises:
            UserError: Something that a group reads is damaged, or workers keep dying.
        """
        ...


@runtime_checkable
class Executor(Protocol):
    """Where groups run."""

    def workers(self) -> AbstractContextManager[Workers]:
        """Gathers the workers, and lets them go at the end, also of an interrupted measurement.

        Raises:
            UserError: There are none to be had.
        """
        ...


class Local:
    """This process: one group after the other, each on every core."""

    count = 1
    description: str | None = None

    @contextmanager
    def workers(self) -> Iterator[Workers]:
        """Itself."""
        yield self

    def run(self, searches: Iterable[SeedSearch]) -> Generator[SeedSearch, None, None]:
        """Runs each search to its end before it takes the next one."""
        for search in searches:
            while (plan := search.next_plan()) is not None:
                with search.clock.working():
                    points = run_group(search.inputs, plan, advance=search.advance)
                search.take(plan, points)
            yield search


WORTH_PROCESSES = 500_000
"""Training steps from which on processes pay: starting one takes as long as some 100,000. Ours."""


def on_this_machine(searches: int, env_steps: int, luggage: Any) -> Executor:
    """The fastest executor of this machine; the numbers are the same in all of them.

    Args:
        searches: Seeds that are searched side by side.
        env_steps: Training steps of all of them.
        luggage: What workers would have to be sent; where it cannot be, this process does it all.
    """
    from rigid.compute.executors.processes import Processes

    count = workers_on_this_machine(searches, env_steps, luggage)
    return Local() if count == 1 else Processes(count)


def workers_on_this_machine(searches: int, env_steps: int, luggage: Any) -> int:
    """How many groups run at a time with `on_this_machine`, given the same."""
    from rigid.compute.executors.processes import can_be_sent
    from rigid.cores import cores

    count = min(len(cores()), searches)
    if count == 1 or env_steps < WORTH_PROCESSES or not can_be_sent(luggage):
        return 1
    return count


def find_executor(name: str) -> Executor | None:
    """The executor called `name`.

    Args:
        name: `local`; `ray`, which joins the Ray that runs on this machine or else starts one; or
            `ray:HOST:PORT`, which joins that cluster.

    Returns:
        It, or None for `local`: `on_this_machine` chooses once the work is known.

    Raises:
        UserError: There is no such executor, Ray is not installed, or nobody answers there.
    """
    kind, colon, address = name.partition(":")
    if name == "local":
        return None
    if kind == "ray" and bool(colon) == bool(address):
        from rigid.compute.executors.ray_executor import RayExecutor

        return RayExecutor(address or None)
    close = difflib.get_close_matches(name, ("local", "ray"), n=1)
    suggestion = f", did you mean {close[0]!r}?" if close else ";"
    raise UserError(f"executor {name!r} is unknown{suggestion} executors: {_KINDS}")
