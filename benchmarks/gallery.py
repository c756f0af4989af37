"""Pictures of real failures for the documentation: `python -m benchmarks.gallery`.

For each run the worst episode of the most adversarial human at naturalness 0.8 or more, from 0.4 to
0.8, and below 0.4, at its moment of greatest unwanted force or else of greatest deviation, beside
canonical motion from the same start; and a figure of how keypoints moved in them. Everything that
the page says is read from the runs.
"""

from __future__ import annotations

import inspect
import io
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import tyro
from jaxtyping import Float, UInt8
from PIL import Image

from benchmarks.command import exit_code
from rigid.compute.pairs.moments import Moment, moment, people_in
from rigid.errors import UserError
from rigid.files import write_atomically
from rigid.report.film import FilmSettings, Take, film
from rigid.report.gather import episode, stored_episodes
from rigid.report.keypoints import keypoint_figure, save_figure
from rigid.report.motion import Motion
from rigid.report.sources import Run, open_run, stored, worst_by_band

_QUALITY = 70
"""Of WebP; at 50 thin lines of the keypoints smear. Ours."""
_FIGURE = 1100
"""Width of the figure of keypoints [pixels]: its smallest letters can just be read. Ours."""
_MOST = 300_000
"""All pictures together [bytes]: the documentation is part of the repository."""


@dataclass(frozen=True)
class _At(FilmSettings):
    """A film of one picture."""

    frame: int = 0

    def times(self, motion: Motion) -> Float[np.ndarray, " 1"]:
        """That moment."""
        return np.array([min(self.frame, motion.last)], dtype=float)


class Still(NamedTuple):
    """A failure in one picture."""

    point: Mapping[str, Any]
    outcome: str
    moment: Moment
    dt: float
    """Of a control step [s]."""
    picture: UInt8[np.ndarray, "h w 3"]


@dataclass(frozen=True)
class Gallery:
    """Draw failures of finished runs for the documentation: pictures and docs/gallery.md.

    Example:
      python -m benchmarks.gallery runs/paper/seed-0/runs/vanilla
    """

    runs: Annotated[tuple[Path, ...], tyro.conf.Positional]
    """Finished run directories with their adversaries, of a task with a picture."""
    out: Path = Path("docs")
    """Folder for gallery.md and gallery/."""

    def run(self) -> None:
        """Draws and writes everything."""
        if not self.runs:
            raise UserError("name finished run directories, as runs/paper/seed-0/runs/vanilla")
        pictures: dict[str, bytes] = {}
        sections = []
        for directory in self.runs:
            run, name = open_run(directory), directory.name
            stills = stills_of(run)
            for still in stills:
                pictures[f"{name}-{still.point['id']}.webp"] = webp(Image.fromarray(still.picture))
            pictures[f"{name}-keypoints.webp"] = webp(keypoints_of(run))
            sections.append(section(name, directory, run, stills))
        total = sum(map(len, pictures.values()))
        if total > _MOST:
            raise UserError(f"{total:,} bytes of pictures, more than {_MOST:,}: name fewer runs")
        before = shown_on(self.out / "gallery.md")
        (self.out / "gallery").mkdir(parents=True, exist_ok=True)
        for name, data in pictures.items():
            write_atomically(self.out / "gallery" / name, data)
        write_atomically(self.out / "gallery.md", page(self.runs, sections).encode())
        for name in before - pictures.keys():
            (self.out / "gallery" / name).unlink(missing_ok=True)
        print(f"{len(pictures)} pictures, {total:,} bytes: {self.out / 'gallery.md'}")


def shown_on(page: Path) -> set[str]:
    """Names of the pictures of an earlier gallery."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    return set(re.findall(r"\]\(gallery/([\w.-]+\.webp)\)", text))


def stills_of(run: Run) -> list[Still]:
    """One picture for each band of naturalness in which the run found somebody."""
    people = people_in(run.task)
    found = []
    for point in worst_by_band(run.frontier.points):
        arrays = stored_episodes(run.frontier, point)
        mine = episode(run.task, arrays, "worst")
        beside = episode(run.task, arrays, "worst", canonical=True)
        when = moment(mine, beside, people, "danger")
        shown = stored(run, point, "worst")
        assert shown.canonical is not None
        takes = [Take(shown.motion, "adversary"), Take(shown.canonical, "canonical, same start")]
        (picture,) = film(run.scene, takes, _At(width=360, height=270, frame=when.step))
        outcome = str(mine["outcome"]).replace("_", " ")
        found.append(Still(point, outcome, when, shown.motion.dt, picture))
    return found


def keypoints_of(run: Run) -> Image.Image:
    """The figure of `rigid export --keypoints`."""
    shown = [stored(run, point, "worst") for point in worst_by_band(run.frontier.points)]
    figure = Image.open(io.BytesIO(save_figure(keypoint_figure(run.scene, shown), ".png")))
    height = round(figure.height * _FIGURE / figure.width)
    return figure.convert("RGB").resize((_FIGURE, height), Image.Resampling.LANCZOS)


def webp(picture: Image.Image) -> bytes:
    """A picture as a file."""
    file = io.BytesIO()
    picture.save(file, "WEBP", quality=_QUALITY, method=6)
    return file.getvalue()


def section(name: str, directory: Path, run: Run, stills: Sequence[Still]) -> str:
    """What the page says of one run."""
    data = run.frontier.data
    helped = _percent(data["canonical"]["success"])
    lines = [
        f"## {name}\n",
        f"`{directory}`: preset `{data['preset']}`, {len(data['auc_by_seed'])} search seeds,",
        f"{len(run.frontier.points)} adversaries; canonical play helps in {helped} of episodes.\n",
    ]
    for still in stills:
        shown = f"{name}-{still.point['id']}"
        lines.append(f"![{shown}, beside canonical motion](gallery/{shown}.webp)\n")
        lines.append(f"{caption(still)}\n")
    what = f"How hand, elbow and tool moved in these episodes of {name}"
    return "\n".join([*lines, f"![{what}](gallery/{name}-keypoints.webp)\n"])


def caption(still: Still) -> str:
    """What a picture shows, in words."""
    point, when = still.point, still.moment
    why = {"force": "at its greatest unwanted force", "deviation": "farthest from canonical motion"}
    return (
        f"`{point['id']}`, naturalness {point['naturalness']:.2f}, adversarialness "
        f"{point['adversarialness']:.2f}: the robot helps this human in "
        f"{_percent(point['success'])} of episodes. Shown is the worst of them (outcome: "
        f"{still.outcome}), {why[when.by]}, {when.step * still.dt:.1f} s after its start."
    )


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %"


_ABOVE = """# Failures, as they are found

The most harmful human whom the search found in each band of naturalness (0.8 or more, 0.4 to 0.8,
below 0.4), beside canonical motion from the same start. What the robot touches and should not is
red; the ring marks the itch. In a report each of them plays in 3D ([failures by kind](failures.md),
[films and figures](export.md)).

Drawn from runs of `make paper` by

<!-- not run: needs the raw runs of make paper -->

```bash
python -m benchmarks.gallery RUNS
```
"""


def page(runs: Sequence[Path], sections: Sequence[str]) -> str:
    """The page of the documentation."""
    return "\n".join([_ABOVE.replace("RUNS", " ".join(map(str, runs))), *sections])


def main(arguments: Sequence[str] | None = None) -> int:
    """Draws the gallery: 0 done, 2 bad input."""
    options = tyro.cli(
        Gallery, args=arguments, prog="python -m benchmarks.gallery",
        description=inspect.getdoc(Gallery),
    )  # fmt: skip
    return exit_code("gallery", options.run)


if __name__ == "__main__":
    sys.exit(main())
