"""Objects of a user's making, by name: `KIND:MODULE:FACTORY`, for policies and tasks.

Importing runs code; but the user wrote the name on the command line.
"""

from __future__ import annotations

import difflib
import hashlib
import importlib
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from rigid.errors import UserError


def call_factory(name: str, folder: str) -> Any:
    """What `FACTORY()` of `MODULE` gives.

    Args:
        name: `KIND:MODULE:FACTORY`, as the user wrote it.
        folder: Where the module is looked for before what is installed.

    Raises:
        UserError: There is no such module or factory, or it fails.
    """
    factory = _find(name, folder)
    try:
        return factory()
    except UserError:
        raise
    except Exception as error:  # noqa: BLE001 - It is the user's code, which may raise anything.
        hint = _hint(error, factory)
        raise UserError(f"{name}: calling the factory fails: {told(error)}{hint}") from None


def told(error: BaseException) -> str:
    """An error of somebody else's code in one line, with its place."""
    line = traceback.format_exception_only(error)[-1].strip()
    if isinstance(error, SyntaxError):  # Its frames are those of the import.
        return f"{line} ({error.filename}:{error.lineno})"
    frames = traceback.extract_tb(error.__traceback__)
    return f"{line} ({frames[-1].filename}:{frames[-1].lineno})" if frames else line


def find_module(name: str, folder: str) -> ModuleType:
    """The module of a name, imported.

    Args:
        name: `KIND:MODULE:FACTORY`, as the user wrote it.
        folder: Where it is looked for before what is installed.

    Raises:
        UserError: There is none, it fails, or the name has another form.
    """
    module, _, attribute = name.partition(":")[2].partition(":")
    if not attribute or not all(part.isidentifier() for part in module.split(".")):
        raise UserError(f"{name!r} names no factory in a module: {_form(name)}")
    return _imported(name, module, folder)


def source_fingerprint(name: str, folder: str) -> str:
    """SHA-256 over a name and the bytes of its module's file; what that imports is not seen.

    Args:
        name: `KIND:MODULE:FACTORY`, as the user wrote it.
        folder: Where the module is looked for before what is installed.

    Raises:
        UserError: As `find_module` does, or the module has no file.
    """
    file = find_module(name, folder).__file__
    if file is None:
        raise UserError(f"{name}: the module has no file: {_form(name)}")
    return hashlib.sha256(f"{name}\0".encode() + Path(file).read_bytes()).hexdigest()


def _form(name: str) -> str:
    kind = name.partition(":")[0]
    return f"write {kind}:MODULE:FACTORY, as {kind}:my_code:make"


def _find(name: str, folder: str) -> Callable[[], Any]:
    found: Any = find_module(name, folder)
    form = _form(name)
    for part in name.split(":", 2)[2].split("."):
        if not hasattr(found, part):
            close = difflib.get_close_matches(part, dir(found), n=1)
            hint = f", did you mean {close[0]!r}?" if close else ":"
            raise UserError(f"{name}: the module has no {part!r}{hint} {form}")
        found = getattr(found, part)
    if not callable(found):
        raise UserError(f"{name} is a {type(found).__name__}, but must be a function: {form}")
    factory: Callable[[], Any] = found
    return factory


def _imported(name: str, module: str, folder: str) -> ModuleType:
    if folder not in sys.path:
        sys.path.insert(0, folder)  # As `python -m`; it may import its neighbours later.
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not f"{module}.".startswith(f"{error.name}."):
            raise UserError(f"{name}: importing {module} fails: {told(error)}") from None
        raise UserError(
            f"{name}: there is no module {error.name!r}, neither in {folder} nor installed"
            f": {_form(name)}"
        ) from None
    except Exception as error:  # noqa: BLE001 - It is the user's code, which may raise anything.
        raise UserError(f"{name}: importing {module} fails: {told(error)}") from None
    return found


def _hint(error: Exception, factory: Callable[..., Any]) -> str:
    missing = isinstance(error, TypeError) and "argument" in str(error)
    if not missing:
        return ""
    called = getattr(factory, "__name__", "the function")
    return f"; a factory takes no arguments: write one that calls {called} with yours"
