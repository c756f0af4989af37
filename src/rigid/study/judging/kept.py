"""Motions on disk: made once, found by what they show, and never mistaken for another.

`clips/<SHA-256>.json` are the motions by their own content, and `clips/index.json` says which of
them shows what.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from rigid.files import json_text, write_atomically, writing_to

_FORMAT = 1
"""Part of what a motion is found by: raise it when motions are made otherwise."""


class _Index(BaseModel):
    model_config = ConfigDict(strict=True)

    clips: dict[str, str] = {}
    """Hash of what a motion shows → hash of its content."""


class KeptClips:
    """The motions in a folder. One that is missing or damaged is as good as never made."""

    def __init__(self, folder: Path) -> None:
        """Opens the folder, which need not exist."""
        self._folder = folder
        self._index = _read_index(folder / "index.json")

    def get(self, shows: Mapping[str, Any]) -> bytes | None:
        """The motion that shows this, if it is there."""
        content = self._index.clips.get(_hash(_text(shows)))
        path = self._folder / f"{content}.json"
        if content is None or not path.is_file():
            return None
        data = path.read_bytes()
        return data if _hash(data) == content else None

    def put(self, shows: Mapping[str, Any], clip: bytes) -> None:
        """Keeps a motion.

        Raises:
            UserError: The folder cannot be written.
        """
        content = _hash(clip)
        self._index.clips[_hash(_text(shows))] = content
        with writing_to(self._folder, "--data"):
            self._folder.mkdir(parents=True, exist_ok=True)
            write_atomically(self._folder / f"{content}.json", clip)
            write_atomically(
                self._folder / "index.json", json_text(self._index.model_dump()).encode()
            )


def _read_index(path: Path) -> _Index:
    try:
        return _Index.model_validate_json(path.read_bytes())
    except (OSError, ValidationError):
        return _Index()


def _text(shows: Mapping[str, Any]) -> bytes:
    return json.dumps({"format": _FORMAT, **shows}, sort_keys=True).encode()


def _hash(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
