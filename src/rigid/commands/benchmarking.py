"""`rigid bench`: how fast, as ratios of one run."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from rigid.commands.parsing import at_least

_SHOWN = (
    ("physics_env_steps_per_s", "MuJoCo alone", "env steps/s"),
    ("training_env_steps_per_s", "adversary training", "env steps/s"),
    ("training_over_physics", "training over physics", ""),
    ("paper_core_hours", "preset paper", "core-hours (the paper says 648)"),
    ("standard_wall_s", "preset standard", "s"),
    ("startup_s", "rigid --help", "s"),
)


@dataclass(frozen=True, kw_only=True)
class BenchCommand:
    """Measure speed as ratios, side by side in one run; about ten minutes on two idle cores.

    Examples:
      rigid bench
      rigid bench --standard --json benchmarks/latest.json
    """

    json: Annotated[Path | None, tyro.conf.arg(metavar="FILE")] = None
    """Where to write the figures; those of the last run there are shown beside them."""
    standard: bool = False
    """Also measure a whole run of preset `standard`."""
    repeats: int = 7
    """Iterations of which medians are taken."""

    def run(self) -> int:
        """Measures, prints and stores."""
        at_least("--repeats", self.repeats, 1)
        from rigid.files import json_text, make_room, write_atomically, writing_to

        before = _last(self.json)
        if self.json is not None:
            make_room(self.json, "--json")
        found = _measured(self)
        print(_table(found, before))
        if self.json is not None:
            with writing_to(self.json, "--json"):
                write_atomically(self.json, (json_text(found, indent=1) + "\n").encode())
        return 0


def _measured(options: BenchCommand) -> dict[str, Any]:
    from tempfile import TemporaryDirectory

    from rich.console import Console

    from rigid.compute import bench
    from rigid.presets import PRESETS

    say = Console(stderr=True).print
    found = bench.machine()
    say("start-up", highlight=False)
    found["startup_s"] = round(bench.start_up_seconds(options.repeats), 3)
    say("training against physics", highlight=False)
    with TemporaryDirectory() as directory:
        inputs = bench.group_inputs(PRESETS["paper"], Path(directory))
        speed = bench.training_against_physics(inputs, options.repeats)
    found |= {
        "physics_env_steps_per_s": round(speed.physics),
        "training_env_steps_per_s": round(speed.training),
        "training_over_physics": round(speed.ratio, 3),
    }
    say("one round of preset paper: some minutes", highlight=False)
    found |= bench.paper_core_hours()
    found["standard_wall_s"] = None
    if options.standard:
        say("preset standard: some more minutes", highlight=False)
        found["standard_wall_s"] = round(bench.standard_wall_seconds(), 1)
    return found


def _last(path: Path | None) -> dict[str, Any]:
    """The figures of an earlier run, if there are any that can be read."""
    try:
        return dict(json.loads(path.read_text())) if path is not None else {}
    except (OSError, ValueError, TypeError):
        return {}


def _table(found: dict[str, Any], before: dict[str, Any]) -> str:
    lines = []
    for key, label, unit in _SHOWN:
        value, old = found[key], before.get(key)
        shown = "not measured" if value is None else f"{value:,} {unit}".rstrip()
        beside = f"   (last run: {old:,})" if isinstance(old, int | float) else ""
        lines.append(f"{label:24}{shown}{beside}")
    where = found["machine"]
    lines.append(f"{where['processor']}, {found['threads']} threads, load {where['load']}")
    return "\n".join(lines)
