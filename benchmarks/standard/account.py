"""`README.md` of the study: a template that is filled from the tables, so that it cannot differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.paired import Row, difference_text, find, markdown
from benchmarks.robots import OWN_HUMAN
from benchmarks.standard.costs import ratio
from benchmarks.standard.pairing import NUMBERS, POOLED, Measured
from benchmarks.standard.plan import CURVE_SEEDS, DECIDING, LIMIT, Plan, Robot
from benchmarks.standard.verdicts import verdict_line
from rigid.presets import Preset

_OVERHEAD = 8
"""Of every measurement [core-s], whatever its preset and seeds; measured with `builtin:vanilla`."""
_TEMPLATE = Path(__file__).with_name("account.md")


def account(
    plan: Plan,
    measured: Mapping[str, Measured],
    rows: Sequence[Row],
    costs: Sequence[Row],
    made_with: Mapping[str, int],
) -> str:
    """The text of `README.md`.

    Args:
        plan: The study, with every seed of which anything is known.
        measured: What is there, by robot.
        rows: From `pairing.table_rows`, those of the means over robots included.
        costs: From `costs.cost_rows`.
        made_with: How many parts were made with what; from `checking.makers`.
    """
    others = [number for number in NUMBERS if number not in DECIDING]
    return _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=plan.stamp, command=plan.command, robots=len(plan.robots), limit=f"{LIMIT:g}",
        complete=_complete(plan, rows), pooled=POOLED, curve=CURVE_SEEDS, human=OWN_HUMAN,
        verdicts="\n".join(
            f"- {verdict_line([find(rows, robot=robot.name, number=name) for name in DECIDING])}"
            for robot in plan.robots
        ),
        deciding=_differences(rows, DECIDING), others=_differences(rows, others),
        costs=_costs(costs), overhead=_OVERHEAD * (CURVE_SEEDS - 1),
        made="\n".join(f"- {_made(plan, robot, measured)}" for robot in plan.robots),
        seeds=", ".join(str(seed) for seed in plan.seeds),
        makers="\n".join(f"- {count} with {maker}" for maker, count in sorted(made_with.items())),
        presets=markdown(
            ("preset", "λ by round", "from λ", "iterations", "episodes", "networks", "scored on"),
            [_preset(name, preset) for name, preset in plan.presets().items()],
        ),
    )  # fmt: skip


def _complete(plan: Plan, rows: Sequence[Row]) -> str:
    count = sum(find(rows, robot=robot.name, number="auc")["seeds"] for robot in plan.robots)
    planned = len(plan.robots) * len(plan.seeds)
    if count < planned:
        return (
            f"**So far {count} of {planned} pairs are complete; the same command goes on, on any "
            "machine that has this folder.**"
        )
    return f"All {count} pairs are complete."


def _differences(rows: Sequence[Row], numbers: Sequence[str]) -> str:
    heads = ("number", "robot", "seeds", "`standard`", "`paper`", "difference")
    cells = [
        [
            f"`{row['number']}`", row["robot"], str(row["seeds"]), _mean(row["standard"]),
            _mean(row["paper"]), difference_text(row),
        ]
        for number in numbers for row in rows if row["number"] == number
    ]  # fmt: skip
    return markdown(heads, cells)


def _mean(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3f}"


def _costs(costs: Sequence[Row]) -> str:
    heads = (
        "robot", "`standard`, core-s", "`paper`, core-s", "ratio", "`standard`, steps",
        "`paper`, steps",
    )  # fmt: skip
    cells = []
    for robot in dict.fromkeys(row["robot"] for row in costs):
        both = [find(costs, robot=robot, preset=preset) for preset in ("standard", "paper")]
        dearer = ratio(costs, robot)
        cells.append([
            robot, *(f"{row['core_seconds']:,.0f}" for row in both),
            "unknown" if dearer is None else f"{dearer:.1f}",
            *(f"{row['env_steps']:,.0f}" for row in both),
        ])  # fmt: skip
    return markdown(heads, cells)


def _made(plan: Plan, robot: Robot, measured: Mapping[str, Measured]) -> str:
    training = robot.training
    how = (
        "bundled"
        if training is None
        else f"as `rigid train vanilla` makes it, {training.iterations} iterations of "
        f"{plan.recipe.episodes} episodes, seed {training.seed}"
    )
    runs = [run for by_seed in measured[robot.name].values() for run in by_seed.values()]
    found = [run.data["canonical"]["success"] for run in runs]
    success = f"; success with its human {found[0]:.2f}" if found else ""
    return f"`{robot.name}`: {how}{success}"


def _preset(name: str, preset: Preset) -> list[str]:
    return [
        f"`{name}`", " + ".join(map(str, preset.per_round)), f"{preset.lambda_min:g}",
        str(preset.iterations), str(preset.episodes),
        "one for each λ" if preset.sharing is None else "two for each seed",
        f"{preset.scoring_episodes} episodes",
    ]  # fmt: skip
