"""`README.md` of the study: a template that is filled from the tables, so that it cannot differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from benchmarks.measures.plan import (
    AGAIN_SHIFT,
    ENSEMBLE,
    MEMBERS,
    REFERENCE,
    ROBOT,
    TASK,
    Plan,
    again_name,
)
from benchmarks.measures.searching import Searched
from benchmarks.measures.summary import MARGIN, NUMBERS, together_name, twice_name
from benchmarks.paired import Row, difference_text, find, markdown, sign, value_text
from benchmarks.short_search import short_settings
from rigid.compute.preparation import settings_for
from rigid.learning.adversary_settings import AdversarySettings

_TEMPLATE = Path(__file__).with_name("account.md")
_SIDES = {1: "finds more than", -1: "finds less than", 0: "cannot be told from"}


def account(plan: Plan, searched: Mapping[str, Searched], rows: Sequence[Row]) -> str:
    """The text of `README.md`."""
    preset, measures = plan.preset, plan.measures
    ppo, usual = short_settings(preset).ppo, settings_for(preset).ppo
    reference = searched[REFERENCE]
    errors = [
        point["naturalness_se"]
        for one in searched.values()
        for point in one.points
        if point["naturalness_se"] is not None
    ]
    return _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=f"\n**{preset.stamp}**\n" if preset.stamp else "",
        count=len(measures), command=plan.command, reference=REFERENCE,
        reference_again=again_name(REFERENCE), seeds=len(reference.by_seed()),
        headlines=_headline_table(rows, list(searched)),
        differences=_difference_table(rows, list(searched)),
        chance=_chance(rows, measures), mmd=_against_reference(rows, "mmd"), margin=MARGIN,
        shares=_share_table(rows, measures), alone=_alone(rows, measures),
        unions=_union_table(rows), ensemble=_ensemble(rows), robot=ROBOT, task=TASK,
        lambda_min=preset.lambda_min, lambda_max=preset.lambda_max,
        per_round=" + ".join(map(str, preset.per_round)), rounds=_rounds(len(preset.per_round)),
        iterations=preset.iterations, episodes=preset.episodes,
        training=reference.points[0]["env_steps"], scoring=preset.scoring_episodes,
        referee=preset.referee_episodes, validation=preset.validation_episodes,
        seed_list=", ".join(map(str, reference.by_seed())), shift=AGAIN_SHIFT,
        anchor=reference.anchor, se=median(errors), largest_se=max(errors),
        natural_start=AdversarySettings().natural_start, rate=ppo.learning_rate,
        minibatch=ppo.minibatch, usual_rate=usual.learning_rate, usual_minibatch=usual.minibatch,
    )  # fmt: skip


def _rounds(count: int) -> str:
    return "1 round" if count == 1 else f"{count} rounds"


def _headline_table(rows: Sequence[Row], names: Sequence[str]) -> str:
    lines = []
    for name in names:
        first = _first_reference(rows, name)
        numbers = [find(rows, name=name, reference=first, number=number) for number in NUMBERS]
        seconds = find(rows, name=name, number="core_seconds")["value"]
        lines.append([f"`{name}`", *map(value_text, numbers), f"{seconds / 60:.1f}"])
    return markdown(("measure", *(f"`{number}`" for number in NUMBERS), "core minutes"), lines)


def _first_reference(rows: Sequence[Row], name: str) -> str:
    """With what a search is compared first; its values are the same in every comparison."""
    return str(next(row["reference"] for row in rows if row["name"] == name))


def _difference_table(rows: Sequence[Row], names: Sequence[str]) -> str:
    lines = [
        [f"`{name}`", *(difference_text(_against(rows, name, number)) for number in NUMBERS)]
        for name in names
        if name != REFERENCE
    ]
    return markdown(("measure", *(f"`{number}`" for number in NUMBERS)), lines)


def _against(rows: Sequence[Row], name: str, number: str) -> Row:
    return find(rows, name=name, reference=REFERENCE, number=number)


def _chance(rows: Sequence[Row], measures: Sequence[str]) -> str:
    compared = [
        (name, number, sign(_against(rows, name, number)))
        for name in measures
        if name != REFERENCE
        for number in NUMBERS
    ]
    told = [f"`{name}` ({'+' if side > 0 else '-'}, `{n}`)" for name, n, side in compared if side]
    listed = f": {', '.join(told)}" if told else ""
    return (
        f"Of these {len(compared)} differences of other measures {len(told)} exclude 0{listed}. "
        f"Chance alone would let about {0.05 * len(compared):.1f} do so."
    )


def _against_reference(rows: Sequence[Row], name: str) -> str:
    found = {number: _against(rows, name, number) for number in NUMBERS}
    said = []
    for side, words in _SIDES.items():
        numbers = [
            f"`{number}` ({difference_text(row)})"
            for number, row in found.items()
            if sign(row) == side
        ]
        if numbers:
            said.append(f"it {words} `{REFERENCE}` by {', '.join(numbers)}")
    text = "; ".join(said)
    return f"{text[0].upper()}{text[1:]}."


def _share_table(rows: Sequence[Row], measures: Sequence[str]) -> str:
    lines = []
    for name in (*measures, again_name(REFERENCE)):
        counts = [
            f"{find(rows, name=name, number=key)['value']:.0f}"
            for key in ("points", "alone", "clearly_alone")
        ]
        area = find(rows, name=name, number="exclusive_area")
        lines.append([f"`{name}`", *counts, value_text(area)])
    return markdown(("measure", "points", "alone", "clearly", "exclusive area"), lines)


def _alone(rows: Sequence[Row], measures: Sequence[str]) -> str:
    def area(name: str) -> float:
        return float(find(rows, name=name, number="exclusive_area")["value"])

    control = area(again_name(REFERENCE))
    above = [f"`{name}`" for name in measures if area(name) > control]
    finders = [
        f"`{name}`"
        for name in measures
        if find(rows, name=name, number="clearly_alone")["value"] > 0
    ]
    return (
        f"Humans that no other measure comes close to were found by {_listed(finders)}. On average "
        f"over seeds {_listed(above)} added more to the others' union than a second search with "
        f"`{REFERENCE}` adds to everybody's ({control:.3f})."
    )


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) if names else "no measure"


def _union_table(rows: Sequence[Row]) -> str:
    pairs = [
        *((ENSEMBLE, member) for member in MEMBERS),
        (twice_name(ENSEMBLE), together_name()),
        (together_name(), twice_name(REFERENCE)),
    ]
    lines = []
    for name, reference in pairs:
        mine = [find(rows, name=name, reference=reference, number=number) for number in NUMBERS]
        lines.append([name, reference, str(mine[0]["searches"]), *map(difference_text, mine)])
    return markdown(("", "minus", "searches", *(f"`{number}`" for number in NUMBERS)), lines)


def _ensemble(rows: Sequence[Row]) -> str:
    against = {
        **{member: (ENSEMBLE, member) for member in MEMBERS},
        f"{together_name()} at equal budget": (twice_name(ENSEMBLE), together_name()),
    }
    said = []
    for text, (name, reference) in against.items():
        sides = [
            sign(find(rows, name=name, reference=reference, number=number)) for number in NUMBERS
        ]
        wins, losses = sides.count(1), sides.count(-1)
        said.append(f"above {text} in {wins} and below it in {losses} of {len(sides)} numbers")
    return f"With its whole interval the ensemble lies {'; '.join(said)}."
