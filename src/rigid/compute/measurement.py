"""Measuring robots, end to end: from their policies to `frontier.json`."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing
from pathlib import Path

from rigid.compute.executors.executor import Executor, on_this_machine
from rigid.compute.listening import Listener, Silence
from rigid.compute.preparation import settings_for
from rigid.compute.robot_run import Order, RobotRun, begin
from rigid.compute.search.seed_search import SeedSearch
from rigid.compute.subject import Subject
from rigid.compute.threads import fix_xla_threads
from rigid.frontier.result import Frontier, load_frontier
from rigid.learning.adversary_settings import AdversarySettings
from rigid.naturalness.choice import DEFAULT_MEASURE
from rigid.presets import Preset


def measure_robot(
    subject: Subject,
    preset: Preset,
    *,
    out: Path,
    seeds: Sequence[int] | None = None,
    lambdas: Sequence[float] | None = None,
    memory: int = 1,
    search_measure: str = DEFAULT_MEASURE,
    settings: AdversarySettings | None = None,
    executor: Executor | None = None,
    listener: Listener | None = None,
) -> Frontier:
    """Measures a robot into `out`, or goes on where an earlier call stopped.

    Args:
        subject: Task, robot, human and canonical data.
        preset: Budget.
        out: Run directory.
        seeds: Search seeds instead of the preset's; those that `out` already has stay.
        lambdas: Exactly these λ, without refinement; 0 and inf are allowed.
        memory: Observations that an adversary acts on.
        search_measure: What holds adversaries close; never what they are judged by.
        settings: How adversaries are trained, in place of what the preset, `memory` and
            `search_measure` say; for studies of the search itself.
        executor: Where groups run; by default on this machine (`on_this_machine`).
        listener: Told of progress.

    Raises:
        UserError: Bad input; nothing was overwritten.
        ValueError: `settings` have another budget than the preset.
    """
    if settings is None:
        settings = settings_for(preset, memory, search_measure)
    else:
        _check_budget(settings, preset)
    order = Order(
        subject=subject, preset=preset, settings=settings, out=out, seeds=seeds, lambdas=lambdas,
        listener=listener or Silence(),
    )  # fmt: skip
    return measure_robots([order], executor)[0]


def measure_robots(orders: Sequence[Order], executor: Executor | None = None) -> list[Frontier]:
    """Measures robots, or goes on where an earlier call stopped; all their groups are one pool.

    A robot is prepared when workers are about to run out of groups, and its `frontier.json` is
    there as soon as its own groups are done.

    Args:
        orders: What to measure, each into a directory of its own.
        executor: Where groups run; by default on this machine (`on_this_machine`).

    Returns:
        The measurements, in the order of `orders`.

    Raises:
        UserError: Bad input. Everything that was measured before stays, and the same call goes on.
    """
    fix_xla_threads()
    for order in orders:
        order.check()
    chosen = executor or on_this_machine(
        sum(order.searches for order in orders),
        sum(order.env_steps for order in orders),
        [order.subject for order in orders],
    )
    with closing(measure_each(orders, chosen)) as complete:
        for _ in complete:
            pass
    return [load_frontier(order.out) for order in orders]


def measure_each(orders: Iterable[Order], executor: Executor) -> Generator[Order, None, None]:
    """Measures robots as `measure_robots` does, and says of each when it is complete.

    Args:
        orders: What to measure; taken one by one, when workers are about to run out of groups.
        executor: Where groups run.

    Yields:
        Orders that were not complete before, each as soon as its `frontier.json` is there. Closing
        the generator interrupts what is under way.

    Raises:
        UserError: Bad input. Everything that was measured before stays, and the same call goes on.
    """
    fix_xla_threads()
    owners: dict[SeedSearch, tuple[RobotRun, ExitStack, Order]] = {}
    with executor.workers() as workers, ExitStack() as locks:
        news = [text for text in (workers.description,) if text is not None]

        def searches() -> Iterator[SeedSearch]:
            for order in orders:
                lock = locks.enter_context(ExitStack())
                run = begin(order, lock)
                if run is None:
                    lock.close()
                    continue
                while news:  # Once for all robots.
                    order.listener.say(news.pop())
                run.announce(workers.count)
                owners.update((search, (run, lock, order)) for search in run.searches)
                yield from run.searches

        with closing(workers.run(searches())) as done:
            for search in done:
                run, lock, order = owners.pop(search)
                if run.close(search):
                    lock.close()
                    yield order


def _check_budget(settings: AdversarySettings, preset: Preset) -> None:
    if settings.sharing != preset.sharing:
        raise ValueError(
            f"settings have sharing {settings.sharing}, but preset {preset.name!r} has "
            f"{preset.sharing}"
        )
    if (settings.iterations, settings.episodes) != (preset.iterations, preset.episodes):
        raise ValueError(
            f"settings train for {settings.iterations} iterations of {settings.episodes} episodes, "
            f"but preset {preset.name!r} for {preset.iterations} of {preset.episodes}"
        )
