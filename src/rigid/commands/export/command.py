"""`rigid export`: films of episodes, the figure of keypoints, and policies as ONNX."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

from rigid.commands.export.keypoints import check_figure, draw_keypoints, line_of
from rigid.commands.export.onnx import write_onnx
from rigid.commands.export.serving import write_serve
from rigid.commands.naming import OpeningOptions
from rigid.commands.parsing import at_least
from rigid.commands.terminal.wrapping import show
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.report.film import FilmSettings
    from rigid.report.motion import Shown

_shown_as = tyro.conf.arg
_OF_RUNS = ("point", "episode", "side_by_side", "keypoints")
_OF_PAIRS = ("robot", "human", "seed", "onnx", "agent", "trust", "vecnormalize", "frames")
_OF_FILMS = (
    "human", "seed", "trust", "vecnormalize", "frames", "size", "fps", "speed",
    "point", "episode", "side_by_side",
)  # fmt: skip
_FINEST = 240
"""Pictures per second; more is no film. Ours."""
_SMALLEST, _LARGEST = 64, 4096
"""Width and height of a film [pixels]; beyond, graphics drivers differ. Ours."""


@dataclass(frozen=True)
class ExportCommand(OpeningOptions):
    """Write a film of an episode, a figure of how keypoints moved, or a policy as ONNX.

    A run is shown by the most adversarial of its points at naturalness 0.8 or more, from 0.4 to
    0.8, and below 0.4: a figure by the worst episodes of all three, a film by an episode of the
    first that there is. Without a run, a film shows a new episode of any robot and human, the one
    of `rigid evaluate --episodes 1` with the same --seed. What the robot touches and should not is
    red while the contact lasts.

    Examples:
      rigid export runs/vanilla --video worst.mp4 --side-by-side
      rigid export runs/vanilla --video median.webp --point s0-r1-l3 --episode median
      rigid export --robot my/robot --human builtin:passive --seed 3 --video episode.mp4
      rigid export runs/vanilla --keypoints failures.pdf
      rigid export --robot builtin:vanilla --onnx vanilla.onnx
      rigid export --robot runs/vanilla/adversaries/s0-r1-l3 --onnx adversary.onnx
      rigid export --serve rigid_serve.py
    """

    directory: Annotated[Path | None, tyro.conf.Positional, _shown_as(metavar="PATH")] = None
    """A finished run directory; leave it out to film any pair."""
    video: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Film to write, over any that is there: .mp4, which needs the extra `video`, or .webp."""
    keypoints: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Figure to write, .pdf, .svg or .png: how keypoints moved in failures of the run."""
    onnx: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Model to write, .onnx: the native policy that --robot names, with its normaliser inside."""
    agent: Literal["robot", "human"] | None = None
    """With --onnx: whose policy it is; by default what its directory says, else the robot's."""
    serve: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Python file to write, rigid_serve.py: programs of yours that import it play as exec:COMMAND.
    It goes alone."""
    point: Annotated[str | None, _shown_as(metavar="ID")] = None
    """Whose episode to film, as s0-r1-l3; by default the most natural one of the above."""
    episode: Literal["worst", "median"] = "worst"
    """Which of its episodes."""
    side_by_side: bool = False
    """Film the synthetic human from the same start beside it."""
    robot: Annotated[str | None, _shown_as(metavar="ROBOT")] = None
    """Without a run: as in `rigid evaluate`; with --onnx builtin:NAME or a native directory."""
    human: str = "builtin:synthetic-human"
    """Without a run: who plays in the film."""
    seed: int = 0
    """Without a run: start and noise of the episode come from it."""
    task: Annotated[str | None, _shown_as(metavar="TASK")] = None
    """Registered task: the run's own if it is one of RIGID's, itch-scratching without a run."""
    size: Annotated[str, _shown_as(metavar="WxH")] = "800x600"
    """Of the film [pixels]; --side-by-side doubles its width."""
    fps: int = 30
    """Pictures per second."""
    speed: float = 1.0
    """1 is real time, 0.5 half of it."""

    def run(self) -> int:
        """Writes what was asked for, and says what it shows."""
        from rigid.files import make_room

        if self.serve is not None:
            if self != ExportCommand(serve=self.serve):
                raise UserError("--serve FILE goes alone: leave the other options out")
            write_serve(self.serve)
            return 0
        self._check_options()
        places = (self.video, "--video"), (self.keypoints, "--keypoints"), (self.onnx, "--onnx")
        for path, option in places:
            if path is not None:
                make_room(path, option)
        if self.onnx is not None and self.robot is not None:
            write_onnx(self.robot, self.onnx, task=self.task, agent=self.agent)
        if self.video is not None:
            _film(self, self.video)
        if self.keypoints is not None and self.directory is not None:
            draw_keypoints(self.directory, self.task, self.keypoints)
        return 0

    def _check_options(self) -> None:
        """Refuses what does not go together."""
        if self.video is None and self.keypoints is None and self.onnx is None:
            raise UserError(
                "name what to write: --video FILE, --keypoints FILE, --onnx FILE or --serve FILE"
            )
        if self.agent is not None and self.onnx is None:
            raise UserError("--agent is for --onnx FILE")
        if self.onnx is not None and self.onnx.suffix != ".onnx":
            raise UserError(f"--onnx {self.onnx}: models end in .onnx")
        if self.directory is None and self.robot is None:
            raise UserError("name a run directory, or --robot for an episode of any pair or --onnx")
        idle = _OF_RUNS if self.directory is None else _OF_PAIRS
        reason = (
            "needs a run directory" if self.directory is None else "goes without a run directory"
        )
        self._refuse_given(idle, reason)
        if self.video is None:
            self._refuse_given(_OF_FILMS, "is for --video FILE")
        at_least("--seed", self.seed, 0)
        if self.video is not None:
            self._check_film(self.video)
        if self.keypoints is not None:
            check_figure(self.keypoints)

    def _refuse_given(self, options: tuple[str, ...], reason: str) -> None:
        """Refuses options that would be ignored."""
        for option in options:
            if getattr(self, option) != getattr(ExportCommand, option):
                raise UserError(f"--{option.replace('_', '-')} {reason}")

    def _check_film(self, path: Path) -> None:
        from rigid.report.encode import check_format

        settings = _settings(self)
        check_format(path, settings.width * (2 if self.side_by_side else 1), settings.height)


def _film(options: ExportCommand, path: Path) -> None:
    """Draws and stores a film."""
    scene, shown = _episode(options)
    settings = _settings(options)
    length = _write_film(path, scene, shown, settings, side_by_side=options.side_by_side)
    show(f"{line_of(shown)}, {length:.1f} s: {path}")


def _episode(options: ExportCommand) -> tuple[Mapping[str, Any], Shown]:
    """The scene, and the episode in it."""
    from rigid.report import sources
    from rigid.tasks.registry import make_task

    if options.directory is None:
        assert options.robot is not None
        task = make_task(options.task or "itch-scratching")
        scene = sources.scene_of(task)
        opening = options.opening()
        return scene, sources.played(task, options.robot, options.human, options.seed, opening)
    run = sources.open_run(options.directory, options.task)
    if options.point is None:
        point = sources.worst_by_band(run.frontier.points)[0]
    else:
        point = sources.point_called(run.frontier, options.point)
    return run.scene, sources.stored(run, point, options.episode)


def _settings(options: ExportCommand) -> FilmSettings:
    """Size and pace; refuses impossible ones."""
    from rigid.report.film import FilmSettings

    found = re.fullmatch(r"(\d{1,5})x(\d{1,5})", options.size)
    width, height = map(int, found.groups()) if found else (0, 0)
    if not (_SMALLEST <= width <= _LARGEST and _SMALLEST <= height <= _LARGEST):
        raise UserError(
            f"--size {options.size!r}: write width x height, as 800x600, each from {_SMALLEST} to "
            f"{_LARGEST} pixels"
        )
    if not 1 <= options.fps <= _FINEST:
        raise UserError(f"--fps is {options.fps}, but must be from 1 to {_FINEST}")
    if not 0 < options.speed < math.inf:
        raise UserError(f"--speed is {options.speed}, but must be more than 0: 1 is real time")
    return FilmSettings(width, height, options.fps, options.speed)


def _write_film(
    path: Path,
    scene: Mapping[str, Any],
    shown: Shown,
    settings: FilmSettings,
    *,
    side_by_side: bool,
) -> float:
    """Draws and stores a film; returns how long it is [s]."""
    from rigid.commands.terminal.progress import TerminalListener
    from rigid.files import write_atomically, writing_to
    from rigid.report.encode import encode
    from rigid.report.film import Take, film

    takes = [Take(shown.motion, shown.title)]
    if side_by_side and shown.canonical is not None:
        takes.append(Take(shown.canonical, "the synthetic human, same start"))
    count = len(settings.times(shown.motion))
    with TerminalListener("filming") as listener:
        listener.expect(count, after="writing")

        def watched() -> Iterator[Any]:
            for picture in film(scene, takes, settings):
                yield picture
                listener.advance(1)

        data = encode(watched(), path.suffix, settings.fps)
    with writing_to(path, "--video"):
        write_atomically(path, data)
    return count / settings.fps
