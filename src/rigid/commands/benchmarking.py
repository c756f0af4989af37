"""`rigid bench`: how fast, as ratios of one run, and what grows with what."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from rigid.commands.parsing import at_least


@dataclass(frozen=True, kw_only=True)
class BenchCommand:
    """Measure speed as ratios, side by side in one run; about ten minutes on two idle cores.

    docs/speed.md says how to read the figures.

    Examples:
      rigid bench
      rigid bench --assistive-gym --growth
      rigid bench --standard --json benchmarks/latest.json
    """

    json: Annotated[Path | None, tyro.conf.arg(metavar="FILE")] = None
    """Where to write the figures; those of the last run there are shown beside them."""
    standard: bool = False
    """Also measure a whole run of preset `standard`."""
    assistive_gym: bool = False
    """Also measure steps per core, beside figures of Assistive Gym that were measured elsewhere."""
    growth: bool = False
    """Also measure how memory and time grow, and what twice the λ cost; about 20 minutes more."""
    repeats: int = 7
    """Turns of which medians are taken."""

    def run(self) -> int:
        """Measures, prints and stores."""
        at_least("--repeats", self.repeats, 1)
        from rigid.commands.speed_tables import growth_table, speed_table
        from rigid.files import json_text, make_room, write_atomically, writing_to

        before = _last(self.json)
        if self.json is not None:
            make_room(self.json, "--json")
        found = _measured(self)
        print(speed_table(found, before))
        if found["growth"] is not None:
            print(growth_table(found["growth"]))
        if self.json is not None:
            with writing_to(self.json, "--json"):
                write_atomically(self.json, (json_text(found, indent=1) + "\n").encode())
        return 0


def _measured(options: BenchCommand) -> dict[str, Any]:
    from rich.console import Console

    from rigid.compute.speed import bench
    from rigid.compute.speed.assistive_gym import beside_assistive_gym

    console = Console(stderr=True)

    def say(text: str) -> None:
        console.print(text, highlight=False)

    say("training, its parts and physics, referee, report, start-up: by turns")
    found = bench.machine() | bench.figures_in_turns(options.repeats)
    say("one round of preset paper: some minutes")
    found |= bench.paper_core_hours()
    found |= {"standard_wall_s": None, "assistive_gym": None, "growth": None}
    if options.assistive_gym:
        say("steps of one core")
        found["assistive_gym"] = beside_assistive_gym(options.repeats)
    if options.standard:
        say("preset standard: some more minutes")
        found["standard_wall_s"] = round(bench.standard_wall_seconds(), 1)
    if options.growth:
        found["growth"] = _growth(options.repeats, say)
    return found


def _growth(repeats: int, say: Callable[[str], None]) -> dict[str, Any]:
    from tempfile import TemporaryDirectory

    from rigid.compute.speed.bench import group_inputs
    from rigid.compute.speed.growth import measured_growth
    from rigid.compute.speed.growth_lambdas import time_of_twice_the_lambdas
    from rigid.presets import PRESETS

    found, twice = measured_growth(say), {}
    for name in ("paper", "standard"):
        say(f"growth: twice the λ of preset {name}")
        with TemporaryDirectory() as directory:
            inputs = group_inputs(PRESETS[name], Path(directory))
            twice[name] = time_of_twice_the_lambdas(inputs, repeats)
    return {**found, "twice_the_lambdas": twice}


def _last(path: Path | None) -> dict[str, Any]:
    """The figures of an earlier run, if there are any that can be read."""
    try:
        return dict(json.loads(path.read_text())) if path is not None else {}
    except (OSError, ValueError, TypeError):
        return {}
