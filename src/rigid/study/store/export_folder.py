"""The directory of an export: it says what it is, and nothing else is ever overwritten."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rigid.errors import UserError
from rigid.files import check_writable, json_text, write_atomically, writing_to
from rigid.study.store import tables

MANIFEST = "export.json"
KIND = "rigid study export"
_OWN = (*tables.COLUMNS, "README.md", "episodes", "canonical", "played")
"""What an export is made of."""


def holds_export(path: Path, data: str) -> bool:
    """Whether a directory holds an export of this data, whole or begun.

    Args:
        path: The directory.
        data: `Notes.identity` of the study's data.
    """
    found = _manifest(path)
    # Older exports do not say whose they are. They count as this study's, since who withdraws is to
    # be taken out of them as well.
    return found is not None and found.get("data", data) == data


def is_export(path: Path) -> bool:
    """Whether a directory holds an export of any data."""
    return _manifest(path) is not None


def check_place(path: Path, data: str) -> None:
    """Refuses a place that holds something else or cannot be written, before any work.

    Args:
        path: The place.
        data: `Notes.identity` of the data that is to be exported.

    Raises:
        UserError: It does, or cannot.
    """
    with writing_to(path):
        path.mkdir(parents=True, exist_ok=True, mode=0o700)
        check_writable(path)
        if not any(path.iterdir()) or holds_export(path, data):
            return
    what = (
        "holds an export of another study, or of other data of the same" if is_export(path)
        else f"is not empty and holds no export (no {MANIFEST})"
    )  # fmt: skip
    raise UserError(f"{path} {what}: choose a new directory with --out")


def _manifest(path: Path) -> dict[str, Any] | None:
    """What the folder of an export says of itself; None for any other folder."""
    try:
        found = json.loads((path / MANIFEST).read_bytes())
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and found.get("kind") == KIND else None


class Folder:
    """Files by name, and their hashes so far."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._hashes: dict[str, str] = {}

    def path(self, name: str) -> Path:
        """Where a file is about to be written by somebody else, who then calls `note`."""
        target = self._path / name
        target.parent.mkdir(parents=True, exist_ok=True)
        return target

    def put(self, name: str, data: bytes) -> None:
        """Writes a file."""
        write_atomically(self.path(name), data)
        self.note(name)

    def note(self, name: str) -> None:
        """A file is there."""
        self._hashes[name] = hashlib.sha256((self._path / name).read_bytes()).hexdigest()

    def hashes(self) -> Mapping[str, str]:
        """SHA-256 of each file, by name."""
        return dict(sorted(self._hashes.items()))


@contextmanager
def written_anew(path: Path, about: Mapping[str, Any]) -> Iterator[Folder]:
    """An export's folder, emptied of what an earlier one wrote; its manifest is completed last.

    Args:
        path: As `check_place` lets it pass.
        about: What the manifest says of the export.
    """
    manifest = {"kind": KIND, "format": 1, **about}
    # First: whatever happens from here on, the folder says that it may be written anew.
    _write_manifest(path, {**manifest, "complete": False})
    for name in _OWN:
        if (path / name).is_dir():
            shutil.rmtree(path / name)
        else:
            (path / name).unlink(missing_ok=True)
    folder = Folder(path)
    yield folder
    _write_manifest(path, {**manifest, "complete": True, "files": folder.hashes()})


def _write_manifest(path: Path, manifest: Mapping[str, Any]) -> None:
    write_atomically(path / MANIFEST, json_text(manifest, indent=1).encode() + b"\n")
