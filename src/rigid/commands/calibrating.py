"""`rigid calibrate`: the range of adversarialness of a new task."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import tyro

from rigid.commands.naming import PairOptions
from rigid.commands.parsing import at_least, parse_seeds
from rigid.commands.terminal.stopping import goes_on
from rigid.commands.terminal.wrapping import tell

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class CalibrateCommand(PairOptions):
    """Measure which returns adversarialness 0 and 1 stand for, and freeze them in a file.

    Adversarialness 0 is the mean return of canonical play, 1 that of λ = 0, an adversary that
    nothing holds close; both are rounded to the power of ten at which their distance has two
    digits. Every measurement of the task should use the same file: rigid frontier --return-range
    FILE.

    Examples:
      rigid calibrate --task my-task --robot my/robot --human my/human --out range.json
      rigid calibrate --task my-task --robot my/robot --human my/human --preset demo --out r.json
    """

    out: Path
    """File to write (.json); the sabotage is kept beside it, in a folder of its name and .run."""
    canonical: Annotated[str | None, _shown_as(metavar="FILE")] = None
    """Canonical episodes; 0 is the mean return of people where they were recorded."""
    preset: str = "paper"
    """How long the sabotage is trained: demo, standard or paper."""
    iterations: Annotated[int | None, _shown_as(metavar="INT")] = None
    """Iterations of each seed's sabotage; by default the preset's."""
    seeds: Annotated[str | None, _shown_as(metavar="SEEDS")] = None
    """Search seeds, as 0,1,2 or 0..9; by default the preset's."""
    executor: Annotated[str, _shown_as(metavar="WHERE")] = "local"
    """local, ray, or ray:HOST:PORT for a Ray cluster; the numbers are the same."""
    json: bool = False
    """Print the file on standard output."""

    def run(self) -> int:
        """Trains the sabotage, plays, and writes the file."""
        seeds = parse_seeds(self.seeds)
        if self.iterations is not None:
            at_least("--iterations", self.iterations, 1)
        from rigid.commands.terminal.progress import TerminalListener
        from rigid.compute.calibration import calibrate
        from rigid.compute.executors.executor import find_executor
        from rigid.compute.subject import Subject
        from rigid.files import make_room
        from rigid.presets import find_preset

        preset = find_preset(self.preset)
        preset = replace(preset, seeds=seeds or preset.seeds)
        preset = replace(preset, iterations=self.iterations or preset.iterations)
        make_room(self.out)
        subject = Subject(
            self.open_task(), self.robot, self.human, self.canonical, opening=self.opening()
        )
        run = self.out.with_name(f"{self.out.stem}.run")
        executor = None if self.executor == "local" else find_executor(self.executor)
        with goes_on(run), TerminalListener(f"{self.robot} · λ = 0") as listener:
            found = calibrate(
                subject, preset, out=self.out, run=run, executor=executor, listener=listener
            )
        print(json.dumps(found) if self.json else said(found, self.out))
        warning = too_far(found)
        if warning is not None:
            tell(f"warning: {warning}")
        return 0


def too_far(found: Mapping[str, Any]) -> str | None:
    """What is wrong with a range in which no natural failure shows, and the cure."""
    from rigid.compute.calibration import FAR, natural_reach, rounded_range

    reach, times = natural_reach(found["returns"])
    if times < FAR:
        return None
    natural = found["returns"].get("recorded", found["returns"]["canonical"])["mean"]
    # Ten times its cost, where canonical play costs something and gains nothing.
    worst, best = rounded_range(natural - (FAR - 1) * reach, natural)
    return (
        f"sabotage lies {times * reach:.4g} below canonical play, {times:.0f} times what canonical "
        f"returns reach themselves ({reach:.2g}): natural failures would all look like "
        "adversarialness 0; to tell them apart, give every measurement a nearer range, such as "
        f"--return-range={worst:g},{best:g}"
    )


def said(found: Mapping[str, Any], out: Path) -> str:
    """The range, and what it was measured on."""
    rows = [
        f"  {kind:10} {spread['mean']:12.4g}  5 to 95 %: {spread['quantiles']['0.05']:.4g} to "
        f"{spread['quantiles']['0.95']:.4g}  ({spread['episodes']} episodes)"
        for kind, spread in found["returns"].items()
    ]
    return "\n".join([
        "",
        "  returns          mean",
        *rows,
        "",
        f"  adversarialness 0 at a return of {found['best']:g}, 1 at {found['worst']:g}",
        f"  use it: rigid frontier --return-range {out}",
    ])  # fmt: skip
