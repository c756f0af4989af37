"""Tasks by name: RIGID's own, and those of installed packages (entry points `rigid.tasks`)."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
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
        name: One of `task_names()`.
        parameters: What the task lets a study vary; `Task.describe()["parameters"]` is accepted.

    Raises:
        UserError: Unknown task or parameter, or a value that the task refuses.

    Example:
        >>> make_task("itch-scratching", body="female").describe()["parameters"]["body"]
        'female'
        >>> make_task("itch-scraching")
        Traceback (most recent call last):
        rigid.errors.UserError: unknown task 'itch-scraching', did you mean 'itch-scratching'?
            Tasks: analytic/hand-tracking, analytic/offset-catch, itch-scratching
    """
    names = task_names()
    if name not in names:
        raise UserError(_unknown("unknown task", name, names))
    recipe = _BUILTIN[name]() if name in _BUILTIN else _installed(_entry_points()[name])
    if recipe.parameters is not None:
        _check_known(f"{name}: unknown parameter", parameters, recipe.parameters)
    return recipe.build(**parameters)


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
        if isinstance(weights := parameters.get("weights"), Mapping):
            _check_known("itch-scratching: unknown weight", weights, _fields(RewardWeights))
            parameters["weights"] = RewardWeights(**weights)
        if isinstance(limbs := parameters.get("itch_limbs"), list):  # As JSON has it.
            parameters["itch_limbs"] = tuple(limbs)
        try:
            return ItchScratching(ItchScratchingParameters(**parameters))
        except TypeError as error:
            raise UserError(f"itch-scratching: a parameter has the wrong type: {error}") from error

    return _Recipe(build, _fields(ItchScratchingParameters))


def _offset_catch() -> _Recipe:
    from rigid.tasks.analytic.offset_catch import OffsetCatch

    return _Recipe(OffsetCatch, ("cost", "tolerance"))


def _hand_tracking() -> _Recipe:
    from rigid.tasks.analytic.hand_tracking import HandTracking

    return _Recipe(HandTracking, ("gain",))


_BUILTIN: dict[str, Callable[[], _Recipe]] = {
    "analytic/hand-tracking": _hand_tracking,
    "analytic/offset-catch": _offset_catch,
    "itch-scratching": _itch_scratching,
}
"""Called only for the task that is asked for, since MuJoCo takes its time to load."""


def _fields(kind: type[Any]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def _check_known(what: str, given: Iterable[str], known: tuple[str, ...]) -> None:
    for name in given:
        if name not in known:
            raise UserError(_unknown(what, name, known, listed="Valid"))


def _unknown(what: str, name: str, names: tuple[str, ...], *, listed: str = "Tasks") -> str:
    close = difflib.get_close_matches(name, names, n=1)
    suggestion = f", did you mean {close[0]!r}?" if close else "."
    return f"{what} {name!r}{suggestion} {listed}: {', '.join(names)}"
