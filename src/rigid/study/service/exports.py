"""Exports for the admin's page, and exports that hold people who withdrew."""

from __future__ import annotations

import logging
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import IO, Final

from rigid.study.store.exports import correct_exports, write_export

_FOLDER = "exports"
_CHUNK: Final = 256 * 1024
"""Bytes that are sent at a time."""
_log = logging.getLogger(__name__)


def zipped_export(data: Path, *, shareable: bool) -> IO[bytes]:
    """What was collected so far as a .zip, at its beginning.

    The export itself stays beside the data, so that people who withdraw later are taken out of it.
    The .zip has no name: nothing of it is left when it is closed, or the server killed.

    Raises:
        UserError: It cannot be written.
    """
    out = data / _FOLDER / ("shareable" if shareable else "everything")
    out.parent.mkdir(mode=0o700, exist_ok=True)
    write_export(data, out, shareable=shareable)
    with ExitStack() as closing:
        file = closing.enter_context(tempfile.TemporaryFile(dir=out.parent))
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in sorted(path for path in out.rglob("*") if path.is_file()):
                archive.write(path, path.relative_to(out))
        file.seek(0)
        closing.pop_all()
        return file


def in_chunks(file: IO[bytes]) -> Iterator[bytes]:
    """All that follows in a file, which is closed in the end."""
    with file:
        while chunk := file.read(_CHUNK):
            yield chunk


def mend_exports(data: Path) -> None:
    """Takes people who withdrew out of exports on this machine; warns of those that are gone."""
    for export in correct_exports(data):
        if not export.mended:
            _log.warning("%s", export.missing())
