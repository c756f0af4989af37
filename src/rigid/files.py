"""Files at the edge: written whole or not at all, and refused with what is wrong."""

from __future__ import annotations

import errno
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rigid.errors import UserError

_DISK_REFUSES = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO}


def write_atomically(path: Path, data: bytes) -> None:
    """Writes `data` to `path`: whoever reads it finds the old file or all of the new one."""
    # Beside the target, since a file cannot be renamed across file systems.
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        error.filename = str(path)  # A write that fails does not say where.
        raise
    finally:
        temporary.unlink(missing_ok=True)


def disk_refusal(error: OSError) -> str | None:
    """What to tell of a file system that took files before and takes none now; None for others.

    Example:
        >>> print(disk_refusal(OSError(errno.ENOSPC, "No space left on device", "runs/a/x.json")))
        runs/a/x.json cannot be written (No space left on device): see to the disk; what was \
        finished before is kept, and the same command goes on
    """
    if error.errno not in _DISK_REFUSES:
        return None
    where = "a file" if error.filename is None else error.filename
    return (
        f"{where} cannot be written ({error.strerror}): see to the disk; what was finished before "
        "is kept, and the same command goes on"
    )


def check_writable(folder: Path) -> None:
    """Tries whether files can be made in `folder`; leaves nothing there.

    Permissions do not tell: root has them all, even where a file system takes no files.

    Raises:
        OSError: They cannot.
    """
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission")
    with tempfile.TemporaryFile(dir=folder):
        pass


def make_room(path: Path, option: str = "--out") -> None:
    """Makes the folder of a file that is written later; refuses a bad place before any work.

    Raises:
        UserError: `path` cannot be written.
    """
    with writing_to(path, option):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            raise IsADirectoryError(0, "Is a directory")
        check_writable(path.parent)


@contextmanager
def writing_to(path: Path, option: str = "--out") -> Iterator[None]:
    """Turns a failure to write into a message; for the places that users name with an option."""
    try:
        yield
    except OSError as error:
        raise UserError(
            f"cannot write to {path} ({error.strerror}): choose another place with {option}"
        ) from None


def read_bytes(path: Path, *, cure: str) -> bytes:
    """The bytes of a file that a user named.

    Raises:
        UserError: It is missing or cannot be read; the message ends with the `cure`.
    """
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise UserError(f"{path} does not exist: {cure}") from None
    except OSError as error:
        raise UserError(f"{path} cannot be read ({error.strerror}): {cure}") from None


def json_text(value: Mapping[str, Any], *, indent: int | None = None) -> str:
    """JSON with sorted keys: equal values give equal text, whether tuples or lists.

    Raises:
        ValueError: A number is NaN or infinite, which JSON does not know.
    """
    return json.dumps(value, sort_keys=True, indent=indent, ensure_ascii=False, allow_nan=False)


def lies_there(path: Path | str, found: Callable[[Path], bool] = Path.exists) -> bool:
    """Whether something lies at what a user wrote, which need not be a path at all.

    A command may be longer than a name can be, which `Path.exists` and its like raise, and nothing
    at all is no name, which they take for the current directory.

    Args:
        path: Whatever was written.
        found: `Path.exists`, `Path.is_dir` or `Path.is_file`.

    Example:
        >>> lies_there("x" * 5000), lies_there("")
        (False, False)
    """
    try:
        return path != "" and found(Path(path))
    except OSError:
        return False


def first_difference(
    mine: Mapping[str, Any], theirs: Mapping[str, Any]
) -> tuple[str, Any, Any] | None:
    """The first entry (dotted name, mine, theirs) in which two JSON mappings differ.

    Only entries that both have count: a newer RIGID may describe more.

    Example:
        >>> first_difference({"a": {"b": (1, 2)}, "c": 1}, {"a": {"b": [1, 3]}})
        ('a.b', (1, 2), [1, 3])
    """
    for name in sorted(mine.keys() & theirs.keys()):
        left, right = mine[name], theirs[name]
        if isinstance(left, Mapping) and isinstance(right, Mapping):
            inner = first_difference(left, right)
            if inner is not None:
                return f"{name}.{inner[0]}", inner[1], inner[2]
        elif json.dumps(left, sort_keys=True) != json.dumps(right, sort_keys=True):
            return name, left, right
    return None
