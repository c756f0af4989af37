"""`README.md` of the results: a template filled from the tables, so that it cannot differ."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.paired import markdown
from benchmarks.paper.failing import figure_of
from benchmarks.paper.places import Places
from benchmarks.paper.plan import RECIPES, Plan
from benchmarks.paper.tables import PAPER, TITLES
from rigid.report.tables import Row

_TEMPLATE = Path(__file__).with_name("account.md")
_NOTHING = "*Not measured yet; the same command goes on.*"


def account(plan: Plan, places: Places, tables: Mapping[str, Sequence[Row]]) -> str:
    """The text.

    Args:
        plan: The experiments.
        places: Where figures lie.
        tables: By name, as in `writing.write_all`.
    """
    rows = tables["table"]
    return _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=plan.stamp, command=plan.command, preset=plan.preset.name,
        seeds=len(plan.preset.seeds), robots=", ".join(map(str, plan.robot_seeds)),
        teachers=teachers(plan, places),
        episodes=plan.evaluation_episodes, complete=_complete(plan, rows),
        comparison=_comparison(rows), differences=_differences(tables["differences"]),
        verdicts="\n".join(f"- {line}" for line in verdicts(rows, tables["differences"])),
        caution=caution(tables["differences"]),
        unseen=_successes(tables["unseen"]), crossplay=_crossplay(tables["crossplay"]),
        thorough=_comparison(tables["thorough"]), bodies=_bodies(tables["bodies"]),
        levels=_levels(tables["levels"]), floors=_floors(tables["floors"]),
        natural=_natural(tables["natural"]), failures=_failures(places, tables["failures"]),
        own_path=places.out.as_posix(),
    )  # fmt: skip


def verdicts(rows: Sequence[Row], differences: Sequence[Row]) -> list[str]:
    """Where our result agrees with the paper's, and where it does not; nothing but the numbers."""
    said = []
    by_name = {row["method"]: row for row in rows}
    if all(name in by_name for name in RECIPES):
        ours = sorted(RECIPES, key=lambda name: by_name[name]["auc"])
        theirs = sorted(RECIPES, key=lambda name: PAPER[name][0])
        agree = "agrees" if ours == theirs else "differs"
        said.append(
            f"Order by `auc`, most robust first: ours {_listed(ours)}; the paper's "
            f"{_listed(theirs)}. It {agree}."
        )
    for name in RECIPES[1:]:
        if name in by_name:
            said += [_against(name, number, differences)
                     for number in ("worst_at", "auc_natural", "auc")]  # fmt: skip
    return said or [_NOTHING]


def caution(differences: Sequence[Row]) -> str:
    """How much a single interval that excludes zero is worth among so many."""
    judged = [row for row in differences if row["difference_low"] is not None]
    apart = sum(row["difference_low"] > 0 or row["difference_high"] < 0 for row in judged)
    return (
        f"Of {len(judged)} differences with a 95 % interval, {apart} exclude zero; one in twenty "
        "does by chance where there is no difference."
    )


def _against(name: str, number: str, differences: Sequence[Row]) -> str:
    (row,) = [r for r in differences if (r["method"], r["number"]) == (name, number)]
    low, high = row["difference_low"], row["difference_high"]
    text = f"{TITLES[name]} minus Vanilla RL, `{number}`: {_interval(row, 'difference', '+.3f')}"
    if low is None:
        return f"{text}: one robot and one search say nothing of others."
    if high < 0:
        return f"{text}: **lower**."
    return f"{text}: **higher**." if low > 0 else f"{text}: cannot be told apart."


def teachers(plan: Plan, places: Places) -> str:
    """Of which search seeds the adversaries were that Robust GT learned from, by its own cards."""
    said = []
    for seed in plan.robot_seeds:
        card = places.kept_policy("robust-gt", seed) / "policy.json"
        if card.exists():
            chosen = json.loads(card.read_text(encoding="utf-8"))["provenance"]["adversaries"]
            seeds = sorted({int(one["id"].split("-")[0].removeprefix("s")) for one in chosen})
            said.append(f"robot {seed} from {len(chosen)} of {', '.join(map(str, seeds))}")
    if not said:
        return "No robot of Robust GT stands yet."
    return (
        f"Robust GT learned from adversaries of other search seeds: {'; '.join(said)}. It is "
        "judged, as all others, by seeds that no training saw."
    )


def _complete(plan: Plan, rows: Sequence[Row]) -> str:
    there = {row["method"]: row["robot_seeds"] for row in rows}
    planned = len(plan.robot_seeds)
    lacking = [
        f"{TITLES[name]} {there.get(name, 0)} of {planned}"
        for name in RECIPES if there.get(name, 0) < planned
    ]  # fmt: skip
    if not lacking:
        return "All robots of all recipes are measured."
    return f"**So far {', '.join(lacking)} robots are measured; the same command goes on.**"


def _comparison(rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    heads = ("method", "worst at ≥ .9 ↓", "mean over [.8, 1] ↓", "AUC ↓", "success ↑", "robots",
             "the paper: AUC, success")  # fmt: skip
    return markdown(heads, [
        [
            _title(row),
            *(_interval(row, column) for column in ("worst_at_0.9", "auc_natural", "auc")),
            _interval(row, "success", ".2f"), str(row["robot_seeds"]), _printed(row["method"]),
        ]
        for row in rows
    ])  # fmt: skip


def _title(row: Row) -> str:
    name = str(row["method"])
    return TITLES.get(name, name)


def _printed(method: str) -> str:
    return "–" if method not in PAPER else "{:.3f}, {:.2f}".format(*PAPER[method])


def _differences(rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    return markdown(("method", "number", "minus Vanilla RL"), [
        [_title(row), f"`{row['number']}`",
         _interval(row, "difference", "+.3f")]
        for row in rows
    ])  # fmt: skip


def _successes(rows: Sequence[Row]) -> str:
    known = [row for row in rows if row["success"] is not None]
    if not known:
        return "*Unknown with one robot seed.*"
    return markdown(("method", "success with unseen humans ↑"), [
        [_title(row), _interval(row, "success", ".2f")]
        for row in known
    ])  # fmt: skip


def _crossplay(rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    humans = list(dict.fromkeys((row["human"], row["human_seed"]) for row in rows))
    robots = list(dict.fromkeys((row["robot"], row["robot_seed"]) for row in rows))
    found = {
        (row["robot"], row["robot_seed"], row["human"], row["human_seed"]): row["success"]
        for row in rows
    }
    heads = ("robot", *(_player(*human) for human in humans))
    return markdown(heads, [
        [_player(*robot), *(f"{found[(*robot, *human)]:.2f}" for human in humans)]
        for robot in robots
    ])  # fmt: skip


def _player(name: str, seed: int) -> str:
    return name if seed < 0 else f"{name} {seed}"


def _bodies(rows: Sequence[Row]) -> str:
    if len(rows) < 2:  # The reference person alone compares nothing.
        return _NOTHING
    heads = (
        "person",
        "success, canonical",
        "adversarialness, canonical",
        "worst at ≥ .9 ↓",
        "mean over [.8, 1] ↓",
        "AUC ↓",
    )
    return markdown(heads, [
        [row["person"], f"{row['success']:.2f}", f"{row['canonical_adversarialness']:.3f}",
         *(_interval(row, column) for column in ("worst_at_0.9", "auc_natural", "auc"))]
        for row in rows
    ])  # fmt: skip


def _levels(rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    methods = list(dict.fromkeys(str(row["method"]) for row in rows))
    heads = (
        "from naturalness", TITLES.get(methods[0], methods[0]),
        *(f"{TITLES.get(name, name)}, minus that" for name in methods[1:]),
    )  # fmt: skip
    by_level: dict[float, list[Row]] = {}
    for row in rows:
        by_level.setdefault(row["naturalness"], []).append(row)
    return markdown(heads, [
        [f"{level:g}", _interval(first, "worst_at"),
         *(_interval(row, "difference", "+.3f") for row in others)]
        for level, (first, *others) in by_level.items()
    ])  # fmt: skip


def _floors(rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    return markdown(("method", "`auc_natural`", "its floor"), [
        [_title(row), f"{row['auc_natural']:.3f}", f"{row['floor']:.3f}"] for row in rows
    ])  # fmt: skip


def _natural(rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    heads = ("method", "humans found", "of them failures", "the worst: success, naturalness")
    return markdown(heads, [
        [
            _title(row), str(row["humans"]), str(row["failures"]),
            "–" if row["point"] is None
            else f"{row['worst_success']:.2f}, {row['worst_naturalness']:.2f} "
            f"(`{row['point']}` of robot {row['robot_seed']})",
        ]
        for row in rows
    ])  # fmt: skip


def _failures(places: Places, rows: Sequence[Row]) -> str:
    if not rows:
        return _NOTHING
    heads = ("method", "robot", "failure", "humans", "naturalness", "share of episodes")
    table = markdown(heads, [
        [
            _title(row), str(row["robot_seed"]), row["failure"], f"{row['humans']} of {row['of']}",
            f"{row['naturalness_low']:.2f} to {row['naturalness_high']:.2f}",
            _percent(row["share"]),
        ]
        for row in rows
    ])  # fmt: skip
    drawn = dict.fromkeys((str(row["method"]), int(row["robot_seed"])) for row in rows)
    links = [
        f"[{TITLES.get(name, name)} {seed}]"
        f"({figure_of(places, name, seed).relative_to(places.results).as_posix()})"
        for name, seed in drawn if figure_of(places, name, seed).exists()
    ]  # fmt: skip
    return f"{table}\n\nKeypoints of the most harmful human in each band of naturalness: " + (
        ", ".join(links) + "."
    )


def _percent(share: float) -> str:
    """Whole percents; of a rare failure, that it was there."""
    return "< 1%" if 0 < share < 0.01 else f"{share:.0%}"


def _interval(row: Row, column: str, form: str = ".3f") -> str:
    value, low, high = row[column], row[f"{column}_low"], row[f"{column}_high"]
    if value is None:
        return "unknown"
    return f"{value:{form}}" if low is None else f"{value:{form}} [{low:{form}}, {high:{form}}]"


def _listed(names: Sequence[str]) -> str:
    return " < ".join(TITLES[name] for name in names)
