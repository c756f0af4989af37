"""The study from its parts to its account."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.physics.account import write_account
from benchmarks.physics.costing import costs
from benchmarks.physics.drawing import draw
from benchmarks.physics.plan import AGED, DEFAULT, FINEST, PAIRS, SETTINGS, SWINGS, Plan
from benchmarks.physics.playing import play_closed
from benchmarks.physics.swinging import swings
from benchmarks.physics.tables import part_name, table
from benchmarks.physics.windows import replay_pair
from benchmarks.study import once, say, write_table
from rigid.compute.run.directory import alone_in
from rigid.errors import UserError


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Makes what is missing in `out`, then writes everything into `results`.

    Raises:
        UserError: `out` holds parts of another plan or a damaged one, or cannot be written.
    """
    with alone_in(out):
        parts = make_parts(plan, out)
    rows = table(parts, plan)
    write_table(results / "table.csv", rows)
    draw(results / "figure.svg", rows)
    write_account(results / "README.md", plan, rows, parts)
    say(f"written: {results / 'README.md'}")


def make_parts(plan: Plan, out: Path) -> dict[str, Any]:
    """Every part by its name; what `out` has is not made again."""
    if once(out / "plan.json", plan.describe) != plan.describe():
        raise UserError(f"{out} holds parts of another plan: choose another place with --out")
    made = {}
    for name, make in works(plan).items():
        path = out / f"{name}.json"
        if not path.exists():
            say(name)
        made[name] = once(path, make)
    return made


def works(plan: Plan) -> dict[str, Callable[[], Any]]:
    """How each part is made."""
    works: dict[str, Callable[[], Any]] = {"cost": partial(costs, plan)}
    for pair in PAIRS:
        works[part_name("windows", pair)] = partial(replay_pair, pair, plan)
    for swing in SWINGS:
        works[part_name("energy", swing)] = partial(swings, swing, plan)
    for pair in PAIRS:
        for one in SETTINGS:
            works[part_name("closed", pair, one)] = partial(play_closed, pair, one, plan)
    for pair in AGED:
        works[part_name("aged", pair)] = partial(play_closed, pair, FINEST, plan, like=DEFAULT)
    return works
