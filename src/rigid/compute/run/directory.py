"""The run directory: what belongs to one measurement, and whether a new one may go on in it."""

from __future__ import annotations

import fcntl
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from rigid.compute.run.provenance import provenance, version_warnings
from rigid.errors import UserError
from rigid.files import (
    check_writable,
    first_difference,
    json_text,
    read_bytes,
    write_atomically,
    writing_to,
)

SCHEMA = 1
_LEFTOVER = re.compile(r"\.settings\.json\.\d+\.tmp|\.lock")
"""What a run that was killed at its very first write leaves behind."""
_ID = re.compile(r"[\w-]+", re.ASCII)


@dataclass(frozen=True)
class RunDirectory:
    """Paths of one measurement on disk."""

    path: Path

    @property
    def settings(self) -> Path:
        """Everything resolved: what is measured, and with what."""
        return self.path / "settings.json"

    @property
    def frontier(self) -> Path:
        """The result; present only when the measurement is complete."""
        return self.path / "frontier.json"

    @property
    def report(self) -> Path:
        """The self-contained page."""
        return self.path / "report.html"

    @property
    def failures(self) -> Path:
        """How the robot fails, for programs; only of tasks that tell."""
        return self.path / "failures.json"

    def adversary(self, point: object) -> Path:
        """Where the adversary of a point's id lies; a stranger's id leads nowhere else.

        Raises:
            UserError: It is no id.
        """
        name = str(point)
        if not _ID.fullmatch(name):
            raise UserError(
                f"{self.frontier} has a point {name!r}, which is no id such as s0-r1-l1"
            )
        return self.path / "adversaries" / name


class OpenRun(NamedTuple):
    """A run directory that is ready for a measurement."""

    directory: RunDirectory
    seeds: tuple[int, ...]
    """Every seed that belongs to the measurement, ascending: also those of earlier commands."""
    warnings: list[str]
    """Library versions that changed since the measurement was begun."""


def check_place(path: Path) -> None:
    """Refuses what can never become this measurement's directory, before any work; makes nothing.

    Raises:
        UserError: `path` cannot be written, holds something else, or damaged settings.
    """
    run = RunDirectory(path)
    with writing_to(path):
        names = [entry.name for entry in path.iterdir()] if path.exists() else []
        held = next(place for place in (path, *path.absolute().parents) if place.exists())
        if not held.is_dir():
            raise NotADirectoryError(0, f"{held} is a file")
        if not run.frontier.exists():
            check_writable(held)
    if run.settings.exists():
        read_settings(run)
    elif not all(_LEFTOVER.fullmatch(name) for name in names):
        raise UserError(
            f"{path} is not empty and holds no measurement (no settings.json): choose a new "
            "directory with --out"
        )


@contextmanager
def alone_in(path: Path) -> Iterator[None]:
    """Keeps other processes out of a run directory; the lock ends with the process, however.

    Raises:
        UserError: Another process is measuring there, or `path` cannot be written.
    """
    if path.exists() and not os.access(path, os.W_OK):  # Nothing can be measured here.
        yield
        return
    with writing_to(path):
        path.mkdir(parents=True, exist_ok=True)
        file = (path / ".lock").open("w")
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UserError(
                f"another process is measuring in {path}: wait for it, or choose another "
                "directory with --out"
            ) from None
        try:
            yield
        finally:
            (path / ".lock").unlink(missing_ok=True)


def is_being_measured(path: Path) -> bool:
    """Whether a living process keeps others out of a run directory; changes nothing there."""
    try:
        file = (path / ".lock").open()
    except OSError:  # There is no lock, or none that we may look at.
        return False
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)  # Let go at once, as the file closes.
        except OSError:
            return True
    return False


def open_run(
    path: Path, identity: Mapping[str, Any], seeds: Sequence[int], command: Sequence[str]
) -> OpenRun:
    """Opens `path` for a measurement: new, to be resumed, or finished.

    Args:
        path: A new or empty directory, or one that holds the same measurement.
        identity: Task, hashes, preset, measure: equal identities give equal numbers.
        seeds: Search seeds; those of an earlier run in `path` are kept.
        command: What the user typed, for the record.

    Raises:
        UserError: `path` cannot be written, holds something else, or another measurement.
    """
    check_place(path)
    run = RunDirectory(path)
    if not run.settings.exists():
        with writing_to(path):
            path.mkdir(parents=True, exist_ok=True)
            _write(run, identity, sorted(seeds), provenance(command))
        return OpenRun(run, tuple(sorted(seeds)), [])
    check_same(path, identity)
    stored = read_settings(run)
    everyone = sorted({*stored["seeds"], *seeds})
    if everyone != stored["seeds"]:
        with writing_to(path):
            # They do not cover every seed.
            for outdated in (run.frontier, run.report, run.failures):
                outdated.unlink(missing_ok=True)
            _write(run, stored["identity"], everyone, stored["provenance"])
    return OpenRun(run, tuple(everyone), version_warnings(stored["provenance"]["versions"]))


_OF_PRESETS = "preset.", "adversary.iterations", "adversary.episodes", "adversary.sharing"
"""Entries of an identity that nobody names one by one."""


def check_same(path: Path, identity: Mapping[str, Any]) -> None:
    """Refuses a directory that holds another measurement; of a part of the identity, that part.

    Raises:
        UserError: It does, or its settings are damaged.
    """
    if not RunDirectory(path).settings.exists():
        return
    stored = read_settings(RunDirectory(path))
    different = first_difference(dict(stored["identity"]), dict(identity))
    if different is not None:
        name, there, here = different
        origin = " (preset or budget)" if name.startswith(_OF_PRESETS) else ""
        raise UserError(
            f"{path} holds a measurement with other settings: {name} is {_short(there)} there and "
            f"{_short(here)} here{origin}; choose another directory with --out, or the same "
            "settings"
        )


def read_settings(run: RunDirectory) -> dict[str, Any]:
    """The settings of a measurement; raises `UserError` when they are missing or damaged."""
    cure = "choose another directory, or delete this one"
    try:
        found: Any = json.loads(read_bytes(run.settings, cure=cure))
        if isinstance(found, dict) and "schema" not in found:
            raise UserError(f"{run.settings} is of something else: choose another directory")
        stored: dict[str, Any] = found
        schema = stored["schema"]
        if schema == SCHEMA:
            _check_complete(stored)
    except (ValueError, KeyError, TypeError):
        raise UserError(f"{run.settings} is damaged: {cure}") from None
    if schema != SCHEMA:
        raise UserError(f"{run.settings} has schema {schema}, this RIGID reads {SCHEMA}: {cure}")
    return stored


def _check_complete(stored: Mapping[str, Any]) -> None:
    """Raises `KeyError` or `TypeError` for settings that nothing could be done with."""
    seeds = stored["seeds"]
    whole = isinstance(seeds, list) and all(isinstance(seed, int) for seed in seeds)
    named = isinstance(stored["identity"], dict)
    if not (whole and named and isinstance(stored["provenance"]["versions"], dict)):
        raise TypeError


def _write(
    run: RunDirectory, identity: Mapping[str, Any], seeds: Sequence[int], made_by: Mapping[str, Any]
) -> None:
    settings = {
        "schema": SCHEMA, "identity": identity, "seeds": list(seeds), "provenance": made_by,
    }  # fmt: skip
    write_atomically(run.settings, json_text(settings, indent=1).encode())


def _short(value: object) -> str:
    text = str(value)
    return text if len(text) <= 40 else f"{text[:37]}…"
