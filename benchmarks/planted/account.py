"""Table, figure and account of the study, all from the parts that were kept."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.planted.arena import Judgement
from benchmarks.planted.ceiling import area
from benchmarks.planted.drawing import draw
from benchmarks.planted.plan import Plan
from benchmarks.planted.verdicts import HALF, MARGIN, advantage, alarm, found, judgements
from benchmarks.study import write_table
from rigid.files import write_atomically

_TEMPLATE = Path(__file__).with_name("account.md")
LABELS = {
    "rigid": "RIGID",
    "clone": "divergence from a clone",
    "diversity": "quality-diversity (CMA-MAE)",
    "sabotage": "sabotage (λ = 0)",
    "noise": "Gaussian noise",
}


class Robot(NamedTuple):
    """Everything that is known of one weakness."""

    name: str
    share: float | None
    truth: Judgement
    canonical: Judgement
    replays: list[Judgement]
    humans: Mapping[str, list[list[Judgement]]]
    """By method and `decoy`: for each seed the humans that were found."""


def write_results(plan: Plan, names: Sequence[str], out: Path, results: Path) -> None:
    """Writes `table.csv`, `figure.svg` and `README.md`."""
    robots = [_read(plan, number, names[number], out) for number in plan.weaknesses]
    rows = [_row(plan, robot) for robot in robots]
    write_table(results / "table.csv", rows)
    draw(results / "figure.svg", plan, robots, LABELS)
    write_atomically(results / "README.md", _account(plan, robots, rows).encode())


def _read(plan: Plan, number: int, name: str, out: Path) -> Robot:
    known = json.loads((out / "truth" / f"{number}.json").read_bytes())
    humans = {
        method: [
            judgements(json.loads((out / method / f"{number}-s{seed}.json").read_bytes()))
            for seed in plan.seeds
        ]
        for method in (*plan.methods, "decoy")
    }
    return Robot(
        name, known["share"], Judgement(**known["truth"]), Judgement(**known["canonical"]),
        judgements(known["replays"]), humans,
    )  # fmt: skip


def _row(plan: Plan, robot: Robot) -> dict[str, Any]:
    true = robot.truth.naturalness
    row: dict[str, Any] = {
        "weakness": robot.name,
        "share_of_canonical": robot.share,
        "true_naturalness": true,
        "shown_by_its_human": robot.truth.shown,
    }
    for method in plan.methods:
        row[f"found_{method}"] = _share([found(one, true) for one in robot.humans[method]])
    row["false_alarm"] = _share([alarm(one, true) for one in robot.humans["decoy"]])
    anchor = robot.canonical.adversarialness
    row["ceiling_area"] = area(robot.replays, anchor) if robot.replays else None
    for method in plan.methods:
        areas = [area(one, anchor) for one in robot.humans[method]]
        row[f"area_{method}"] = sum(areas) / len(areas)
    return row


def _share(marks: Sequence[bool]) -> float:
    return sum(marks) / len(marks)


def _account(plan: Plan, robots: Sequence[Robot], rows: Sequence[Mapping[str, Any]]) -> str:
    events = [row for row in rows if row["ceiling_area"] is not None]
    reached = [row["area_rigid"] / row["ceiling_area"] for row in events]
    return _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=f"\n**{plan.name}**\n" if plan.name.startswith("quick") else "",
        found=f"{sum(row['found_rigid'] for row in rows):g}", robots=len(rows),
        alarms=f"{sum(row['false_alarm'] for row in rows):g}",
        reached=f"{min(reached):.0%} to {max(reached):.0%}" if reached else "unknown",
        table=_table(plan, rows), rivals="\n".join(_rivals(plan, robots)),
        missed=_missed(robots), half=f"{HALF:g}", margin=MARGIN,
        steps=f"{plan.steps:,}", humans=plan.humans, seeds=", ".join(map(str, plan.seeds)),
        iterations=plan.iterations, episodes=plan.episodes,
        lambda_min=plan.lambda_min, lambda_max=plan.lambda_max,
    )  # fmt: skip


def _table(plan: Plan, rows: Sequence[Mapping[str, Any]]) -> str:
    heads = ["weakness", "share of canonical", "true naturalness",
             *(LABELS[method] for method in plan.methods), "false alarm of its decoy",
             "area, share of the ceiling's"]  # fmt: skip
    lines = [heads, ["---"] * len(heads)]
    for row in rows:
        ceiling = row["ceiling_area"]
        lines.append([
            row["weakness"],
            "none" if row["share_of_canonical"] is None else f"{row['share_of_canonical']:.0%}",
            f"{row['true_naturalness']:.2f}",
            *(_mark(row[f"found_{method}"]) for method in plan.methods),
            _mark(row["false_alarm"]),
            "" if ceiling is None else f"{row['area_rigid'] / ceiling:.0%}",
        ])  # fmt: skip
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _mark(share: float) -> str:
    return {0.0: "·", 1.0: "yes"}.get(share, f"{share:.0%} of seeds")


def _rivals(plan: Plan, robots: Sequence[Robot]) -> list[str]:
    """One line for each rival: who found more, with an interval over weaknesses."""
    by_method = {
        method: {
            robot.name: [found(one, robot.truth.naturalness) for one in robot.humans[method]]
            for robot in robots
        }
        for method in plan.methods
    }
    lines = []
    for method in plan.methods[1:]:
        mean, interval = advantage(by_method[plan.methods[0]], by_method[method])
        ends = "" if interval is None else f" [{interval.low:+.2f}, {interval.high:+.2f}]"
        told = interval is not None and (interval.low > 0 or interval.high < 0)
        verdict = "" if told else "; not told apart"
        count = sum(_share(marks) for marks in by_method[method].values())
        lines.append(f"| {LABELS[method]} | {count:g} | {mean:+.2f}{ends}{verdict} |")
    return lines


def _missed(robots: Sequence[Robot]) -> str:
    """What our search did not find, and how near it came."""
    lines = []
    for robot in robots:
        true = robot.truth.naturalness
        for humans in robot.humans["rigid"]:
            if found(humans, true):
                continue
            natural = [one for one in humans if one.naturalness >= true - MARGIN]
            nearest = max((one.shown for one in natural), default=0.0)
            lines.append(
                f"- *{robot.name}* (true naturalness {true:.2f}): the humans found at least "
                f"{true - MARGIN:.2f} natural show it in at most {nearest:.0%} of their episodes."
            )
    return "\n".join(lines) or "Nothing."
