"""Who made a measurement with what: never part of its identity."""

from __future__ import annotations

import hashlib
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from rigid._version import __version__

_LIBRARIES = ("mujoco", "jax", "jaxlib", "numpy", "optax", "scipy")


def command_line() -> list[str]:
    """What the user typed."""
    program = Path(sys.argv[0])
    if program.stem == "rigid" or program.parts[-2:] == ("rigid", "__main__.py"):
        return ["rigid", *sys.argv[1:]]
    if program.name == "__main__.py":  # A study of this repository.
        return ["python", "-m", ".".join(program.parts[-3:-1]), *sys.argv[1:]]
    return list(sys.argv)


def provenance(command: Sequence[str]) -> dict[str, Any]:
    """Who made this with what: never part of a measurement's identity."""
    return {
        "rigid": __version__,
        "command": " ".join(command),
        "versions": versions(),
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}",
        "git_commit": _git_commit(),
    }


def versions() -> dict[str, str]:
    """Of the libraries whose numbers RIGID's are made of."""
    return {name: metadata.version(name) for name in _LIBRARIES}


def source_hash(package: Path = Path(__file__).parents[2]) -> str:
    """SHA-256 over the modules of a package: an editable one changes without its version."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        digest.update(path.relative_to(package).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def _git_commit() -> str | None:
    """The commit of the source tree, None for an installed package."""
    here, program = Path(__file__).resolve(), shutil.which("git")
    if program is None:
        return None

    def git(*command: str) -> str:
        found = subprocess.run(
            [program, "-C", str(here.parent), *command],
            capture_output=True, text=True, check=True, timeout=5,
        )  # fmt: skip
        return found.stdout.strip()

    try:
        # An environment may lie inside a repository of somebody else.
        git("ls-files", "--error-unmatch", here.name)
        return git("rev-parse", "HEAD")
    except (OSError, subprocess.SubprocessError):
        return None


def version_warnings(begun_with: Mapping[str, str]) -> list[str]:
    """What to tell the user of libraries that changed since a measurement was begun."""
    return [
        f"this run was begun with {name} {begun_with[name]}, now it is {metadata.version(name)}: "
        "its numbers may differ in the last digits"
        for name in _LIBRARIES
        if begun_with.get(name, metadata.version(name)) != metadata.version(name)
    ]
