"""Tasks by name.

RIGID's own, those of installed packages (entry points `rigid.tasks`), and bridges to environments
of others (`pettingzoo:`, `gymnasium:`, `exec:`).
"""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from functools import partial
from importlib.metadata import EntryPoint, entry_points
from typing import Any, NamedTuple

from rigid.errors import UserError
from rigid.tasks.protocol import Task

ENTRY_POINTS = "rigid.tasks"
"""Group of entry points. Each names a callable that takes a task's parameters as keywords and
returns the task; its signature says which there are."""


class _Recipe(NamedTuple):
    build: Callable[..., Task]
    parameters: tuple[str, ...] | None
    """What `build` takes; None: whatever it accepts."""


def make_task(name: str, **parameters: Any) -> Task:
    """The task called `name`.

    Args:
        name: One of `task_names()`, or `pettingzoo:MODULE:FACTORY`, `gymnasium:MODULE:FACTORY` or
            `exec:COMMAND` (docs/tasks.md).
        parameters: What the task lets a study vary; `Task.describe()["parameters"]` is accepted.

    Raises:
        UserError: Unknown task or parameter, or a value that the task refuses.

    Example:
        >>> make_task("itch-scratching", body="female").describe()["parameters"]["body"]
        'female'
        >>> make_task("itch-scraching")
        Traceback (most recent call last):
        rigid.errors.UserError: unknown task 'itch-scraching', did you mean 'itch-scratching'?
            Tasks: analytic/hand-tracking, analytic/offset-catch, bed-bathing, feeding, ...
    """
    recipe = _recipe(name)
    if recipe.parameters is not None:
        _check_known(f"{name}: unknown parameter", parameters, recipe.parameters)
    return recipe.build(**parameters)


def task_parameters(name: str) -> tuple[str, ...] | None:
    """What the task called `name` takes as parameters; None where only it knows.

    Raises:
        UserError: There is no such task.
    """
    return _recipe(name).parameters


def task_from_description(description: Mapping[str, Any]) -> Task | None:
    """RIGID's own task that `Task.describe()` came from; None for any other.

    For reading foreign run directories: nothing that they name is ever imported.
    """
    name, parameters = description.get("name"), description.get("parameters")
    if name not in _BUILTIN or not isinstance(parameters, Mapping):
        return None
    try:
        return make_task(name, **parameters)
    except UserError:
        return None


def _recipe(name: str) -> _Recipe:
    if name in _BUILTIN:
        return _BUILTIN[name]()
    kind, colon, _ = name.partition(":")
    if colon and kind in _BRIDGES:
        return _BRIDGES[kind](name)
    names = task_names()
    if name not in names:
        bridges = ", ".join(f"{bridge}:…" for bridge in _BRIDGES)
        raise UserError(f"{_unknown('unknown task', name, names)}, {bridges}")
    return _installed(_entry_points()[name])


def task_names() -> tuple[str, ...]:
    """Every registered task, sorted."""
    return tuple(sorted({*_BUILTIN, *_entry_points()}))


def _entry_points() -> dict[str, EntryPoint]:
    return {point.name: point for point in entry_points(group=ENTRY_POINTS)}


def _installed(point: EntryPoint) -> _Recipe:
    build = point.load()
    known = inspect.signature(build).parameters.values()
    if any(parameter.kind is parameter.VAR_KEYWORD for parameter in known):
        return _Recipe(build, None)
    return _Recipe(build, tuple(parameter.name for parameter in known))


def _itch_scratching() -> _Recipe:
    from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters, RewardWeights
    from rigid.tasks.itch_scratching.task import ItchScratching

    def build(**parameters: Any) -> Task:
        if isinstance(limbs := parameters.get("itch_limbs"), list):  # As JSON has it.
            parameters["itch_limbs"] = tuple(limbs)
        return ItchScratching(ItchScratchingParameters(**parameters))

    return _assistive("itch-scratching", ItchScratchingParameters, RewardWeights, build)


def _feeding() -> _Recipe:
    from rigid.tasks.feeding.parameters import FeedingParameters, RewardWeights
    from rigid.tasks.feeding.task import Feeding

    def build(**parameters: Any) -> Task:
        return Feeding(FeedingParameters(**parameters))

    return _assistive("feeding", FeedingParameters, RewardWeights, build)


def _bed_bathing() -> _Recipe:
    from rigid.tasks.bed_bathing.parameters import BedBathingParameters, RewardWeights
    from rigid.tasks.bed_bathing.task import BedBathing

    def build(**parameters: Any) -> Task:
        return BedBathing(BedBathingParameters(**parameters))

    return _assistive("bed-bathing", BedBathingParameters, RewardWeights, build)


def _assistive(
    name: str, parameters: type[Any], weights: type[Any], build: Callable[..., Task]
) -> _Recipe:
    """The recipe of a task with reward weights, which may come as JSON has them."""

    def checked(**given: Any) -> Task:
        if isinstance(weighed := given.get("weights"), Mapping):
            _check_known(f"{name}: unknown weight", weighed, _own_first(weights))
            given["weights"] = weights(**weighed)
        try:
            return build(**given)
        except TypeError as error:
            raise UserError(f"{name}: a parameter has the wrong type: {error}") from error

    return _Recipe(checked, _fields(parameters))


def _offset_catch() -> _Recipe:
    from rigid.tasks.analytic.offset_catch import OffsetCatch

    return _Recipe(OffsetCatch, ("cost", "tolerance"))


def _hand_tracking() -> _Recipe:
    from rigid.tasks.analytic.hand_tracking import HandTracking

    return _Recipe(HandTracking, ("gain",))


_BUILTIN: dict[str, Callable[[], _Recipe]] = {
    "analytic/hand-tracking": _hand_tracking,
    "analytic/offset-catch": _offset_catch,
    "bed-bathing": _bed_bathing,
    "feeding": _feeding,
    "itch-scratching": _itch_scratching,
}
"""Called only for the task that is asked for, since MuJoCo takes its time to load."""


def _pettingzoo(name: str) -> _Recipe:
    from rigid.tasks.bridges.pettingzoo import pettingzoo_task

    known = ("human_agent", "robot_agent", "horizon")
    return _Recipe(partial(pettingzoo_task, name), known)


def _gymnasium(name: str) -> _Recipe:
    from rigid.tasks.bridges.gymnasium import gymnasium_task

    return _Recipe(partial(gymnasium_task, name), ("horizon",))


def _command(name: str) -> _Recipe:
    from rigid.tasks.bridges.command import open_command_task

    text = name.partition(":")[2]
    return _Recipe(lambda **parameters: open_command_task(text, parameters), None)


_BRIDGES: dict[str, Callable[[str], _Recipe]] = {
    "exec": _command,
    "gymnasium": _gymnasium,
    "pettingzoo": _pettingzoo,
}
"""By what stands before the first colon of a task's name."""


def _fields(kind: type[Any]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def _own_first(kind: type[Any]) -> tuple[str, ...]:
    """Its fields; those that every task has come last."""
    return tuple(sorted(_fields(kind), key=lambda name: name not in kind.__annotations__))


def _check_known(what: str, given: Iterable[str], known: tuple[str, ...]) -> None:
    for name in given:
        if name not in known:
            raise UserError(_unknown(what, name, known, listed="Valid"))


def _unknown(what: str, name: str, names: tuple[str, ...], *, listed: str = "Tasks") -> str:
    close = difflib.get_close_matches(name, names, n=1)
    suggestion = f", did you mean {close[0]!r}?" if close else "."
    return f"{what} {name!r}{suggestion} {listed}: {', '.join(names) or 'none'}"
