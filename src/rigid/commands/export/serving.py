"""`rigid export --serve`: the file by which programs of any Python play in RIGID."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from rigid.errors import UserError


def write_serve(path: Path) -> None:
    """Writes `rigid_serve.py` to `path`, over an older one if need be, and says what to do with it.

    Raises:
        UserError: There is something else, or it cannot be written.
    """
    from rigid.files import make_room, write_atomically, writing_to

    make_room(path, "--serve")
    data = (resources.files("rigid.serving") / "rigid_serve.py").read_bytes()
    first_line = data.splitlines()[0]
    with writing_to(path, "--serve"):
        if path.exists() and not path.read_bytes().startswith(first_line):
            raise UserError(f"--serve {path} would overwrite a file of your own: name another one")
        write_atomically(path, data)
    print(f"{path}: import it in a program of yours (docs/exec.md says how)")
