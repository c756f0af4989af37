"""Makes every part that is missing, in the order in which they tell most, then the results."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from benchmarks.planted.account import write_results
from benchmarks.planted.arena import Arena, arena_for, judge, planted, stated_human, truth
from benchmarks.planted.ceiling import replays
from benchmarks.planted.plan import Plan
from benchmarks.planted.searches import search
from benchmarks.planted.weaknesses import Weakness
from benchmarks.study import once, say
from rigid.errors import UserError
from rigid.policies.gaussian import GaussianPolicy


def run(plan: Plan, out: Path, results: Path) -> None:
    """Runs the study, or what is left of it.

    Raises:
        UserError: `out` holds parts of another plan, or the extra `qd` is not installed.
    """
    if "diversity" in plan.methods and find_spec("ribs") is None:
        raise UserError("quality-diversity search needs ribs: pip install 'rigid-frontier[qd]'")
    parts = plan.parts()
    say(f"{len(parts)} searches of {plan.steps:,} environment steps each")
    if once(out / "plan.json", plan.describe) != _as_json(plan):
        raise UserError(f"{out} holds parts of another plan: give another --out")
    say("fitting the canonical human and placing the thresholds")
    human = stated_human()
    all_of_them = planted(human)
    for number in plan.weaknesses:
        one = all_of_them[number]
        once(out / "truth" / f"{number}.json", partial(_truth, one, human))
    for done, (number, method, seed) in enumerate(parts):
        path = out / method / f"{number}-s{seed}.json"
        if not path.exists():
            say(f"{done + 1}/{len(parts)}: {method} against {all_of_them[number].name!r}")
        once(path, partial(_searched, human, all_of_them[number], method, plan, seed))
    write_results(plan, [weakness.name for weakness in all_of_them], out, results)
    say(f"written to {results}")


def _as_json(plan: Plan) -> dict[str, Any]:
    described = plan.describe()
    return {key: list(v) if isinstance(v, tuple) else v for key, v in described.items()}


def _truth(weakness: Weakness, human: GaussianPolicy) -> dict[str, Any]:
    """How natural the weakness is, canonical play, and the ceiling of an event."""
    arena = arena_for(human, weakness, decoy=False)
    canonical = judge(arena, [human], 0)[0]
    found = truth(arena, human)
    event = weakness.share is not None
    return {
        "share": weakness.share,
        "truth": found._asdict(),
        "canonical": canonical._asdict(),
        "replays": [one._asdict() for one in replays(arena)] if event else [],
    }


def _searched(
    human: GaussianPolicy, weakness: Weakness, method: str, plan: Plan, seed: int
) -> list[dict[str, float]]:
    arena: Arena = arena_for(human, weakness, decoy=method == "decoy")
    humans = search("rigid" if method == "decoy" else method, arena, plan, seed)
    return [one._asdict() for one in judge(arena, humans, seed)]
