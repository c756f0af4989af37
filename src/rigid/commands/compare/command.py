"""`rigid compare`: robots, or ways of making them, against each other."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.compare.files import ComparisonFiles
from rigid.commands.measured import load_measured, parse_methods
from rigid.commands.parsing import at_least
from rigid.commands.terminal.helping import several
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.frontier.standings import Measured
    from rigid.frontier.successes import Played

_shown_as = tyro.conf.arg


@dataclass(frozen=True)
class CompareCommand:
    """Compare robots that were measured alike, paired by search seed; the first is the baseline.

    NAME=DIR,DIR… is one row of several robots, such as a recipe's: robot i of one method pairs with
    robot i of the others, in the order given, so give those that were made for the same synthetic
    human in the same place. Intervals then are over robots and search seeds. NAME given again adds
    robots; a plain DIR beside named methods is a method of one robot.

    The column `hull at` says how bad a natural motion gets when the human may mix two ways of
    moving from episode to episode. It is the steadier number to tell robots apart: in whole
    searches of an analytic task 95 % intervals of its paired differences covered 94 to 96 %, those
    of `worst at` 76 to 87 %.

    Examples:
      rigid compare runs/vanilla runs/mine
      rigid compare runs/* --json > table.json
      rigid compare vanilla=runs/v-0,runs/v-1 robust=runs/r-0,runs/r-1 --page table.html
      rigid compare runs/* --humans pairs/1/human pairs/2/human --csv t.csv --latex t.tex
      rigid compare --robots builtin:vanilla robots/* --out runs/fleet --executor ray
    """

    runs: Annotated[tuple[str, ...], tyro.conf.Positional, several("DIR…")] = ()
    """Finished run directories, or methods as NAME=DIR,DIR…; two directories or more."""
    humans: Annotated[tuple[str, ...], several("HUMAN…")] = ()
    """Also play each robot with these humans, but its own, for success with unseen humans."""
    episodes: int = 200
    """Of each robot with each of --humans."""
    csv: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Write the table as CSV, its columns as docs/comparing.md names them."""
    latex: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Write the table as LaTeX (booktabs)."""
    figure: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Draw all curves on the same axes (.svg, .pdf or .png)."""
    page: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Write a page with table, curves and links to the reports (.html)."""
    robots: Annotated[tuple[str, ...], several("ROBOT…")] = ()
    """Measure these first, each into the folder of its name in --out; what is there goes on."""
    out: Annotated[Path | None, _shown_as(metavar="DIR")] = None
    """Where --robots are measured."""
    task: str = "itch-scratching"
    """Registered task of --robots."""
    human: str = "builtin:synthetic-human"
    """The synthetic human that --robots were trained for."""
    preset: str = "standard"
    """Budget of --robots: demo, standard or paper."""
    seeds: Annotated[str | None, _shown_as(metavar="SEEDS")] = None
    """Search seeds of --robots, as 0,1,2 or 0..9; by default the preset's."""
    return_range: Annotated[str | None, _shown_as(metavar="LOW,HIGH|FILE")] = None
    """Returns that map to adversarialness 1 and 0 of --robots, or a file of rigid calibrate."""
    trust: bool = False
    """Open --robots whose files can run code (sb3, torchscript): only from people you trust."""
    executor: Annotated[str, _shown_as(metavar="WHERE")] = "local"
    """Where --robots are measured: local, ray, or ray:HOST:PORT for a Ray cluster."""
    json: bool = False
    """Print the table as JSON."""

    def run(self) -> int:
        """Prints the table and writes what was asked for."""
        files = ComparisonFiles(csv=self.csv, latex=self.latex, figure=self.figure, page=self.page)
        self._check_options()
        named = parse_methods(self.runs, self._fleet())
        if sum(map(len, named.methods.values())) < 2:
            raise UserError(
                "compare takes two or more: run directories, or --robots to be measured"
            )
        files.check()
        there = {  # Bad ones are refused before any hours pass.
            path: load_measured(path)
            for paths in parse_methods(self.runs).methods.values()
            for path in paths
        }
        self._measure()
        methods = {
            name: [there.get(path) or load_measured(path) for path in paths]
            for name, paths in named.methods.items()
        }
        self._show(methods, files, grouped=named.grouped)
        return 0

    def _show(
        self, methods: Mapping[str, Sequence[Measured]], files: ComparisonFiles, *, grouped: bool
    ) -> None:
        from rigid.commands.compare.in_json import methods_as_json, robots_as_json
        from rigid.commands.compare.table import table
        from rigid.commands.terminal.wrapping import columns
        from rigid.frontier.standings import notes_of, standings_of, unlike_pairs

        standings = standings_of(methods)  # Refuses what cannot be compared before anybody plays.
        if self.humans:
            standings = standings_of(methods, self._unseen(methods))
        notes = [*unlike_pairs(methods), *notes_of(standings)]
        written = files.write(standings, notes)
        if self.json:
            as_json = methods_as_json if grouped else robots_as_json
            print(json.dumps(as_json(standings, asked=bool(self.humans)), indent=1))
            return
        print(table(standings, notes, width=columns()))
        for path in written:
            print(f"written: {path}")

    def _unseen(self, methods: Mapping[str, Sequence[Measured]]) -> list[Played]:
        """What robots achieve with `--humans`."""
        from rigid.commands.terminal.progress import counted
        from rigid.compute.unseen import play_unseen

        everyone = [run for measured in methods.values() for run in measured]
        return play_unseen(
            everyone, self.humans, episodes=self.episodes,
            track=lambda pairs: counted("unseen humans", pairs),
        )  # fmt: skip

    def _check_options(self) -> None:
        """Refuses what does not go together."""
        at_least("--episodes", self.episodes, 1)
        if not self.humans and self.episodes != CompareCommand.episodes:
            raise UserError("--episodes is for --humans: name the humans to be played with")
        if not self.robots:
            self._refuse_measuring()
        elif self.out is None:
            raise UserError("--robots need --out DIR, where they are measured")

    def _fleet(self) -> list[Path]:
        """The run directories of `--robots`."""
        from rigid.commands.compare.fleet import names_of

        return [] if self.out is None else [self.out / name for name in names_of(self.robots)]

    def _measure(self) -> None:
        """Completes the measurements of `--robots`."""
        from rigid.commands.compare.fleet import measure_fleet

        if self.out is not None:
            measure_fleet(
                self.robots, out=self.out, task=self.task, human=self.human, preset=self.preset,
                seeds=self.seeds, executor=self.executor, return_range=self.return_range,
                trust=self.trust,
            )  # fmt: skip

    def _refuse_measuring(self) -> None:
        """Refuses what would have no effect without `--robots`."""
        for name in (
            "out", "task", "human", "preset", "seeds", "return_range", "trust", "executor",
        ):  # fmt: skip
            if getattr(self, name) != getattr(CompareCommand, name):
                option = name.replace("_", "-")
                raise UserError(f"--{option} is for --robots: name the robots to be measured")
