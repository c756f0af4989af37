"""`rigid demo`, `rigid frontier`, `rigid report`: from a robot to its frontier."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from rigid.commands.naming import PairOptions
from rigid.commands.parsing import parse_budget, parse_lambdas, parse_seeds
from rigid.commands.ranging import RangeOptions
from rigid.commands.terminal.stopping import goes_on
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.frontier.result import Frontier
    from rigid.presets import Preset
    from rigid.tasks.protocol import Task

_shown_as = tyro.conf.arg
_USELESS = 0.5
"""Success with its own human below which a robot is said not to do its task yet. Ours."""


@dataclass(frozen=True, kw_only=True)
class FrontierCommand(RangeOptions, PairOptions):
    """Measure a robot: find the natural human motions that break it.

    Examples:
      rigid frontier --robot builtin:vanilla --out runs/vanilla
      rigid frontier --robot my/robot --human my/human --preset paper --seeds 0..2 --out runs/mine
      rigid frontier --robot my/robot --human my/human --lambdas 0,0.1,inf --seeds 0 --out runs/x
      rigid frontier --robot my/robot --human my/human --executor ray:10.0.0.1:6379 --out runs/mine
      rigid frontier --robot my/robot --human my/human --return-range=-100,20 --out runs/mine
    """

    out: Path
    """Run directory; an interrupted measurement in it goes on."""
    canonical: Annotated[str | None, _shown_as(metavar="FILE")] = None
    """File of canonical episodes; by default the robot's own, or a fresh recording."""
    preset: str = "standard"
    """demo, standard or paper."""
    seeds: Annotated[str | None, _shown_as(metavar="SEEDS")] = None
    """Search seeds, as 0,1,2 or 0..9; by default the preset's."""
    lambdas: Annotated[str | None, _shown_as(metavar="LAMBDAS")] = None
    """Exactly these weights, as 0,0.01,1,inf, without refinement."""
    memory: int = 1
    """Observations that an adversary acts on, the newest included."""
    search_measure: Annotated[str, _shown_as(metavar="NAME")] = "lsgan"
    """What holds adversaries close: lsgan, paper_d2, kl, kl-gan, mmd, temporal or ensemble."""
    features: Annotated[str, _shown_as(metavar="NAMES")] = "default"
    """What naturalness sees: default, observation, observation+action, or the task's by name."""
    budget: Annotated[str | None, _shown_as(metavar="TIME")] = None
    """Fit the preset to a time of this machine: 90s, 30m, 2h; not for a cluster."""
    executor: Annotated[str, _shown_as(metavar="WHERE")] = "local"
    """local, ray, or ray:HOST:PORT for a Ray cluster; the numbers are the same."""
    json: bool = False
    """Print frontier.json on standard output."""

    def run(self) -> int:
        """Measures, reports, and prints the headline."""
        return _measure(self)


@dataclass(frozen=True, kw_only=True)
class DemoCommand:
    """Measure the bundled robot in about three minutes, as `make demo` does.

    Example:
      rigid demo --out runs/demo
    """

    out: Path = Path("runs/demo")
    """Run directory."""

    def run(self) -> int:
        """Measures the bundled robot with the preset `demo`."""
        return _measure(FrontierCommand(out=self.out, preset="demo"))


@dataclass(frozen=True)
class ReportCommand:
    """Rebuild report.html from a finished run directory.

    Example:
      rigid report runs/demo
    """

    directory: Annotated[Path, tyro.conf.Positional]
    """A finished run directory."""
    out: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Where to write it; report.html in the directory by default."""

    def run(self) -> int:
        """Writes the report and prints its path."""
        from rigid.frontier.result import load_frontier

        print(_draw(load_frontier(self.directory), self.out))
        return 0


def _draw(frontier: Frontier, out: Path | None = None) -> Path:
    """Writes the report, with a bar: it plays two episodes of each adversary again."""
    from rigid.commands.terminal.progress import TerminalListener
    from rigid.report.gather import write_report

    with TerminalListener("drawing the report") as listener:
        listener.expect(len(frontier.points), after="writing")
        return write_report(frontier.directory, out, drawn=listener.advance)


def _measure(options: FrontierCommand) -> int:
    seeds, lambdas = parse_seeds(options.seeds), parse_lambdas(options.lambdas)
    budget = parse_budget(options.budget)
    from rigid.api import measure
    from rigid.commands.terminal.progress import TerminalListener
    from rigid.presets import find_preset

    task = options.open_task()
    preset = find_preset(options.preset)
    if seeds is not None:
        preset = replace(preset, seeds=seeds)
    if budget is not None:
        if options.executor != "local":
            raise UserError(
                f"--budget times this machine, not --executor {options.executor}: leave it out, or "
                "choose --preset and --seeds"
            )
        preset = _fitted(preset, options, task, budget, lambdas)
    what = f"{options.robot} · {preset.name}"
    with goes_on(options.out), TerminalListener(what, then="report") as listener:
        frontier = measure(
            task, options.robot, out=options.out, preset=preset, seeds=preset.seeds,
            lambdas=lambdas, memory=options.memory, search_measure=options.search_measure,
            features=options.features, human=options.human, canonical=options.canonical,
            executor=options.executor, opening=options.opening(), listener=listener,
            return_range=options.return_range,
        )  # fmt: skip
    report = options.out / "report.html"
    if not report.exists():
        with goes_on(options.out):
            _draw(frontier)
    print(json.dumps(dict(frontier.data)) if options.json else headline(frontier, report))
    return 0


def _fitted(
    preset: Preset,
    options: FrontierCommand,
    task: Task,
    seconds: float,
    lambdas: tuple[float, ...] | None,
) -> Preset:
    """The preset that `--budget` stands for; what was begun keeps its own."""
    from rigid.compute.budget import fit_here, stored_preset
    from rigid.compute.run.directory import check_place

    stored = stored_preset(options.out, preset)
    if stored is not None:  # Its seeds stay, and those that the user names join them.
        return stored if options.seeds is None else replace(stored, seeds=preset.seeds)
    check_place(options.out)
    rounds = preset.per_round if lambdas is None else (len(lambdas),)
    fitted = fit_here(replace(preset, per_round=rounds), seconds, task)
    return replace(fitted, per_round=preset.per_round)


def headline(frontier: Frontier, report: Path) -> str:
    """What the terminal shows at the end."""
    from rigid.commands.terminal.wrapping import columns, wrapped
    from rigid.compute.return_range import spoken_range

    data, width = frontier.data, columns()
    worst, natural = data["worst_at_interval"]["0.9"], data["auc_natural_interval"]
    lines = [
        "",
        f"  worst at naturalness ≥ 0.9   {data['worst_at']['0.9']:.2f}  {_interval(worst)}",
        f"  mean over [0.8, 1]           {data['auc_natural']:.2f}  {_interval(natural)}",
        f"  AUC                          {data['auc']:.2f}  {_interval(data['auc_interval'])}",
        f"  {len(frontier.points)} adversaries, {_seeds(data)}; lower is better",
        f"  adversarialness is {spoken_range(data)}",
        "  an estimate at this search power, not a bound",
    ]
    lacking = frontier.lacking_at(0.9)
    if lacking is not None:
        lines.append(f"  {lacking}")
    success = data["canonical"]["success"]
    if success is not None and success < _USELESS:
        lines.append(
            f"  canonical play succeeds in {100 * success:.0f} % of episodes: a robot that does "
            "not do its task yet has little to lose; train it first"
        )
    if data.get("stamp"):
        lines.append(f"  {data['stamp']}")
    shown = (wrapped(line, width, hanging=" " * 4) for line in lines)
    return "\n".join([*shown, "", f"report: {report}"])


def _seeds(data: Mapping[str, Any]) -> str:
    count = len(data["auc_by_seed"])
    return "1 seed" if count == 1 else f"{count} seeds"


def _interval(ends: list[float] | None) -> str:
    return "[one seed: no interval]" if ends is None else f"[{ends[0]:.2f}, {ends[1]:.2f}]"
