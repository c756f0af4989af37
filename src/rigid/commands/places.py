"""Files that a command writes: what lies there already is not lost without a word."""

from __future__ import annotations

from pathlib import Path

from rigid.errors import UserError
from rigid.files import make_room


def new_file(path: Path, *, overwrite: bool = False) -> None:
    """Makes room for a file of recorded people; one that is there stays, unless it is given up.

    Args:
        path: What the user named with --out.
        overwrite: Whether the user said that it may go.

    Raises:
        UserError: `path` cannot be written, or holds something.
    """
    make_room(path)
    if path.exists() and not overwrite:
        raise UserError(
            f"{path} exists already, and would be lost with what people consented to: choose "
            "another file with --out, or give it up with --overwrite"
        )


def file_played_again(path: Path) -> None:
    """Makes room for episodes that policies play: only a file of such episodes is replaced.

    They can be played again from their seeds; people cannot.

    Raises:
        UserError: `path` cannot be written, or holds people's episodes or something else.
    """
    from rigid.data.episodes import load_episodes

    make_room(path)
    if not path.exists():
        return
    try:
        kind = load_episodes(path, task=None).source
    except UserError:
        kind = None
    if kind != "synthetic":
        held = "episodes of people" if kind == "recorded" else "something else than episodes"
        raise UserError(f"{path} holds {held}: choose another file with --out")
