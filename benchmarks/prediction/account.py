"""`README.md` of the study: a template that is filled from the tables, so that it cannot differ."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import median

from benchmarks.prediction.assembling import PEOPLE, Row
from benchmarks.prediction.associations import COMPETENT, CONTRASTS, find
from benchmarks.prediction.drawing import letters
from benchmarks.prediction.plan import GROUPS, Plan
from benchmarks.prediction.predictors import BASELINE, HEADLINES, PREDICTORS
from benchmarks.prediction.verdicts import against, among_competent, told_from_chance

_MAIN = {"robots": "all", "humans": "all", "target": "adversarialness"}
"""The question that was fixed before anything was measured; all others are beside it."""

_TEMPLATE = Path(__file__).with_name("account.md")


def account(
    plan: Plan,
    table: Sequence[Row],
    meetings: Sequence[Row],
    correlations: Sequence[Row],
    differences: Sequence[Row],
) -> str:
    """The text of `README.md`: the template, filled from the rows of the tables."""
    preset, humans = plan.preset, plan.humans()
    successes = [row["success"] for row in table]
    seeds = len(preset.seeds)
    return _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=f"\n**{preset.stamp}**\n" if preset.stamp else "",
        command=plan.command, n=len(table), met=len(humans), baseline=BASELINE,
        main=_main_table(correlations),
        competent=sum(success >= COMPETENT for success in successes), least=COMPETENT,
        verdicts="\n".join(f"- {line}" for line in _verdicts(correlations, differences)),
        groups=_group_table(correlations), robots=_robot_table(table),
        success_low=min(successes), success_high=max(successes),
        episodes=plan.episodes, pair_iterations=plan.pair_settings.iterations,
        humans=_human_table(meetings), preset=preset.name,
        seeds=", ".join(map(str, preset.seeds)),
        per_round=" + ".join(map(str, preset.per_round)),
        rounds="1 round" if len(preset.per_round) == 1 else f"{len(preset.per_round)} rounds",
        iterations=preset.iterations, search_episodes=preset.episodes,
        scoring=preset.scoring_episodes, referee=preset.referee_episodes,
        validation=preset.validation_episodes, resamples=f"{plan.resamples:,}",
        seed_count=seeds, seed_share=f"{seeds - 1}/{seeds}",
        group_sizes=", ".join(
            str(sum(human.group == group for human in humans)) for group in GROUPS
        ),
    )  # fmt: skip


def _verdicts(correlations: Sequence[Row], differences: Sequence[Row]) -> list[str]:
    main = [find(correlations, **_MAIN, predictor=name) for name in HEADLINES]
    competent = {**_MAIN, "robots": "competent"}
    contrasts = [find(differences, **_MAIN, first=a, second=b) for a, b in CONTRASTS]
    return [
        told_from_chance(main),
        *(against(row) for row in contrasts),
        among_competent([find(correlations, **competent, predictor=name) for name in HEADLINES]),
    ]


def _main_table(correlations: Sequence[Row]) -> str:
    rows = []
    for name in PREDICTORS:
        row = find(correlations, **_MAIN, predictor=name)
        few = find(correlations, **{**_MAIN, "robots": "competent"}, predictor=name)
        rows.append([
            f"`{name}`", _between(row, "tau"), _number(row["tau_p"], 4), _number(row["rho"]),
            _between(row, "tau_partial"), _between(few, "tau"),
        ])  # fmt: skip
    heads = ("number", "τ-b", "p", "ρ", f"beyond `{BASELINE}`", "τ-b, competent")
    return _markdown(heads, rows)


def _group_table(correlations: Sequence[Row]) -> str:
    rows = []
    for name in PREDICTORS:
        found = [
            find(correlations, robots="all", humans=people, target=target, predictor=name)["tau"]
            for target in ("adversarialness", "unhelped") for people in PEOPLE
        ]  # fmt: skip
        rows.append([f"`{name}`", *(_number(value) for value in found)])
    heads = ("number", *PEOPLE, *(f"1 - success, {people}" for people in PEOPLE))
    return _markdown(heads, rows)


def _robot_table(table: Sequence[Row]) -> str:
    rows = [
        [
            letter, str(row["iterations"]), str(row["seed"]),
            f"{row['noise_start']:g} – {row['noise_end']:g}", _number(row["success"]),
            _between(row, "worst_at_0.9"), _between(row, "auc_natural"), _between(row, "auc"),
            _number(row["adversarialness_all"]), _number(row["unhelped_all"]),
        ]
        for letter, row in zip(letters(len(table)), table, strict=True)
    ]  # fmt: skip
    heads = (
        "", "iterations", "seed", "noise", "success", "`worst_at_0.9`", "`auc_natural`", "`auc`",
        "adversarialness", "1 - success",
    )  # fmt: skip
    return _markdown(heads, rows)


def _human_table(meetings: Sequence[Row]) -> str:
    names = {row["human"]: row["group"] for row in meetings}
    rows = []
    for name, group in names.items():
        mine = [row for row in meetings if row["human"] == name]
        spread = (_spread([row[key] for row in mine]) for key in ("adversarialness", "success"))
        rows.append([name, group, *spread])
    return _markdown(("human", "group", "adversarialness", "success"), rows)


def _spread(values: Sequence[float]) -> str:
    return " – ".join(_number(value) for value in (min(values), median(values), max(values)))


def _between(row: Row, name: str) -> str:
    if row[name] is None:
        return "undefined"
    low, high = row[f"{name}_low"], row[f"{name}_high"]
    interval = "" if low is None else f" [{low:.2f}, {high:.2f}]"
    return f"{row[name]:.2f}{interval}"


def _number(value: float | None, digits: int = 2) -> str:
    return "undefined" if value is None else f"{value:.{digits}f}"


def _markdown(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
