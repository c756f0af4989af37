"""Finished measurements as people name them: run directories, and methods of several robots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rigid.commands.parsing import printable
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.frontier.result import Frontier


class Named(NamedTuple):
    """The run directories of a comparison."""

    methods: Mapping[str, Sequence[Path]]
    """By what each method is called, in the order given."""
    grouped: bool
    """Whether the user named methods; otherwise each directory is a robot."""


def load_measured(directory: Path) -> tuple[Frontier, Mapping[str, Any]]:
    """A finished measurement and its identity.

    Raises:
        UserError: It is unfinished or damaged.
    """
    from rigid.compute.run.directory import RunDirectory, read_settings
    from rigid.frontier.result import load_frontier

    frontier = load_frontier(directory)
    return frontier, read_settings(RunDirectory(directory))["identity"]


def parse_methods(arguments: Sequence[str], measured: Sequence[Path] = ()) -> Named:
    """What stands before the options of `rigid compare`.

    `NAME=DIR,DIR…` is a method of several robots, and NAME given again adds to it; any other text
    is one run directory, and beside named methods a method of one robot. A directory that exists is
    taken for one, whatever signs its path has.

    Args:
        arguments: As the user wrote them.
        measured: More run directories, after those.

    Raises:
        UserError: A method has no name, no directory or that of another, or a directory is named
            twice.

    Example:
        >>> parse_methods(["v=runs/v-0,runs/v-1", "runs/mine"]).methods
        {'v': [PosixPath('runs/v-0'), PosixPath('runs/v-1')], 'mine': [PosixPath('runs/mine')]}
    """
    methods: dict[str, list[Path]] = {}
    plain: list[Path] = []
    order: list[str | Path] = []
    for argument in arguments:
        name, equals, places = argument.partition("=")
        if not equals or "/" in name or Path(argument).is_dir():
            plain.append(Path(argument))
            order.append(Path(argument))
            continue
        if not name.strip() or not all(part.strip() for part in places.split(",")):
            raise UserError(f"{argument!r} is no method: write NAME=DIR or NAME=DIR,DIR")
        name = printable(name.strip())
        if name not in methods:
            order.append(name)
        methods.setdefault(name, []).extend(Path(place.strip()) for place in places.split(","))
    plain += measured
    order += measured
    _refuse_repeats([*plain, *(place for places in methods.values() for place in places)])
    called = dict(zip(plain, _names(plain), strict=True))
    both = set(called.values()) & set(methods)
    if both:
        raise UserError(
            f"two methods are called {min(both)!r}: name the run directory as well, as NAME=DIR"
        )
    found: dict[str, Sequence[Path]] = {}
    for entry in order:
        if isinstance(entry, str):
            found[entry] = methods[entry]
        else:
            found[called[entry]] = [entry]
    return Named(found, bool(methods))


def _refuse_repeats(places: Sequence[Path]) -> None:
    known: set[Path] = set()
    for place in places:
        if place.resolve() in known:
            raise UserError(f"compare was given the same run directory twice: {place}")
        known.add(place.resolve())


def _names(directories: Sequence[Path]) -> list[str]:
    """The last part of each path, or all of it where that is not enough to tell them apart."""
    short = [directory.resolve().name for directory in directories]
    names = short if len(set(short)) == len(short) else [str(path) for path in directories]
    return [printable(name) for name in names]
