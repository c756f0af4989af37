"""`rigid export --keypoints`: the figure of how keypoints moved in a run's failures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rigid.commands.parsing import printable
from rigid.commands.terminal.wrapping import show
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.report.motion import Shown


def check_figure(path: Path) -> None:
    """Refuses a figure of no known format.

    Raises:
        UserError: It ends in something else.
    """
    from rigid.report.keypoints import FORMATS

    if path.suffix.lower() not in FORMATS:
        raise UserError(f"--keypoints {path}: figures end in .pdf, .svg or .png")


def draw_keypoints(directory: Path, task: str | None, path: Path) -> None:
    """Draws and stores the figure of a run's failures."""
    from rigid.commands.terminal.progress import TerminalListener
    from rigid.files import write_atomically, writing_to
    from rigid.report import sources
    from rigid.report.keypoints import keypoint_figure, save_figure

    run = sources.open_run(directory, task)
    points = sources.worst_by_band(run.frontier.points)
    episodes = []
    with TerminalListener("drawing") as listener:
        listener.expect(len(points) + 1, after="writing")
        for point in points:
            episodes.append(sources.stored(run, point, "worst"))
            listener.advance(1)
        data = save_figure(keypoint_figure(run.scene, episodes), path.suffix)
        listener.advance(1)
    with writing_to(path, "--keypoints"):
        write_atomically(path, data)
    for shown in episodes:
        show(line_of(shown))
    print(path)


def line_of(shown: Shown) -> str:
    """An episode's title in one line."""
    return printable(shown.title.replace("\n", ", "))
