"""`README.md` of the study: a template that is filled from the tables, so that it cannot differ."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.ablations.humans import CANONICAL, NOISE
from benchmarks.ablations.plan import ROBOT, TASK, Plan, Variant
from benchmarks.ablations.sizes import DISCRIMINATOR, REFEREE, settled
from benchmarks.ablations.summary import DEFAULT_NAME, NUMBERS, at
from benchmarks.paired import Row, difference_text, find, markdown, sign, value_text
from rigid.compute.preparation import Prepared, settings_for

TOLERANCE = 0.05
"""A reading nearer than this has settled: a twentieth of the axis. Ours."""
_TEMPLATE = Path(__file__).with_name("account.md")
_PAPER_ITERATIONS = 120
"""Paper, appendix 'Computational Complexity'."""


def account(plan: Plan, rows: Sequence[Row], sizes: Sequence[Row], prepared: Prepared) -> str:
    """The text of `README.md`."""
    preset, variants = plan.preset, plan.variants()
    others = variants[1:]
    settings, usual = plan.default.settings, settings_for(preset)
    first = find(rows, name=DEFAULT_NAME, number=NUMBERS[0])
    return _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=f"\n**{preset.stamp}**\n" if preset.stamp else "", command=plan.command,
        lambdas=", ".join(f"{value:g}" for value in plan.lambdas),
        seed_list=", ".join(map(str, preset.seeds)), seeds=first["seeds"],
        values=_values(rows, variants), differences=_differences(rows, others),
        chance=_chance(rows, others), verdicts="\n".join(_verdicts(rows, others)),
        by_lambda=_by_lambda(rows, plan), definitions="\n".join(map(_definition, variants)),
        first_seed=preset.seeds[0], noise=NOISE, sets=plan.sizes.repeats, tolerance=TOLERANCE,
        most=plan.sizes.episodes[-1], discriminator=_size_table(sizes, DISCRIMINATOR),
        referee=_size_table(sizes, REFEREE), sizes=_sizes(sizes, plan), robot=ROBOT, task=TASK,
        iterations=preset.iterations, episodes=preset.episodes,
        training=preset.iterations * preset.episodes * prepared.task.horizon,
        rate=settings.ppo.learning_rate, minibatch=settings.ppo.minibatch,
        usual_rate=usual.ppo.learning_rate, usual_minibatch=usual.ppo.minibatch,
        scoring=preset.scoring_episodes,
        referee_episodes=preset.referee_episodes, validation=preset.validation_episodes,
        anchor=prepared.canonical["adversarialness"], size_train=plan.sizes.train,
        size_validation=plan.sizes.validation, size_test=plan.sizes.test,
        size_iterations=plan.sizes.iterations,
        size_steps=plan.sizes.iterations * settings.discriminator.steps,
        paper_noise=10 * 0.98**preset.iterations, paper_noise_full=10 * 0.98**_PAPER_ITERATIONS,
        compared=len(others) * len(NUMBERS),
    )  # fmt: skip


def _values(rows: Sequence[Row], variants: Sequence[Variant]) -> str:
    lines = [
        [f"`{v.name}`", *(value_text(find(rows, name=v.name, number=n)) for n in NUMBERS)]
        for v in variants
    ]
    return markdown(("variant", *map(_head, NUMBERS)), lines)


def _differences(rows: Sequence[Row], others: Sequence[Variant]) -> str:
    lines = [
        [f"`{v.name}`", *(_marked(find(rows, name=v.name, number=n)) for n in NUMBERS)]
        for v in others
    ]
    return markdown(("variant", *map(_head, NUMBERS)), lines)


def _head(number: str) -> str:
    return number.replace("_", " ")


def _marked(row: Row) -> str:
    """Bold where the interval excludes 0."""
    text = difference_text(row)
    return f"**{text}**" if sign(row) else text


def _chance(rows: Sequence[Row], others: Sequence[Variant]) -> str:
    signs = [sign(find(rows, name=v.name, number=n)) for v in others for n in NUMBERS]
    told = sum(side != 0 for side in signs)
    return (
        f"Bold: the interval excludes 0, as {told} of {len(signs)} do; chance alone would let "
        f"about {0.05 * len(signs):.1f}."
    )


def _verdicts(rows: Sequence[Row], others: Sequence[Variant]) -> list[str]:
    """For every factor what its variants change with their whole interval."""
    lines = []
    for factor in dict.fromkeys(variant.factor for variant in others):
        parts = [
            f"`{variant.name}` {_changes(rows, variant)}"
            for variant in others
            if variant.factor == factor
        ]
        lines.append(f"- **{factor}**: {'; '.join(parts)}.")
    return lines


def _changes(rows: Sequence[Row], variant: Variant) -> str:
    found = {number: find(rows, name=variant.name, number=number) for number in NUMBERS}
    words = {1: "raises", -1: "lowers"}
    changed = [
        f"{words[sign(row)]} {_head(number)} by {abs(row['difference']):.3f}"
        for number, row in found.items()
        if sign(row)
    ]
    return ", ".join(changed) or "cannot be told from the default"


def _by_lambda(rows: Sequence[Row], plan: Plan) -> str:
    def cell(name: str, lambda_: float) -> str:
        x, y = (
            find(rows, name=name, number=at(number, lambda_))["value"]
            for number in ("naturalness", "adversarialness")
        )
        return "unknown" if x is None else f"{x:.2f}, {y:.2f}"

    lines = [[f"`{v.name}`", *(cell(v.name, value) for value in plan.lambdas)]
             for v in plan.variants()]  # fmt: skip
    return markdown(("variant", *(f"λ = {value:g}" for value in plan.lambdas)), lines)


def _definition(variant: Variant) -> str:
    own = variant.settings.discriminator
    noise = f"noise {own.noise:g} × {own.noise_decay:g} per iteration, at least {own.noise_floor:g}"
    weights = f"weights {own.canonical_weight:g} : {own.adversary_weight:g}"
    start = f"canonical start from λ = {variant.settings.natural_start:g} on"
    return (
        f"| `{variant.name}` | {noise}; gradient penalty {own.gradient_penalty:g}; {weights}; "
        f"replay {own.replay_share:g}; features {variant.features}; {start} |"
    )


def _size_table(sizes: Sequence[Row], judge: str) -> str:
    mine = [row for row in sizes if row["judge"] == judge]
    episodes = sorted({row["episodes"] for row in mine})
    lines = []
    for human in dict.fromkeys(row["human"] for row in mine):
        readings = _readings(mine, human)
        cells = [f"{readings[size]:.2f}" for size in episodes]
        lines.append([human, *cells, str(settled(readings, TOLERANCE))])
    return markdown(("human", *(f"n = {size}" for size in episodes), "settles"), lines)


def _readings(rows: Sequence[Row], human: str) -> dict[int, float]:
    return {row["episodes"]: row["naturalness"] for row in rows if row["human"] == human}


def _sizes(sizes: Sequence[Row], plan: Plan) -> str:
    said = []
    for judge in (DISCRIMINATOR, REFEREE):
        mine = [row for row in sizes if row["judge"] == judge]
        humans = list(dict.fromkeys(row["human"] for row in mine))
        needed = {human: settled(_readings(mine, human), TOLERANCE) for human in humans}
        canonical = _readings(mine, CANONICAL)
        ends = plan.sizes.episodes[0], plan.sizes.episodes[-1]
        passed = [
            min(row["canonical_passed"] for row in mine if row["episodes"] == end) for end in ends
        ]
        said.append(
            f"With the {judge} every reading has settled from n = {max(needed.values())} on. "
            f"Canonical behaviour that it has not seen reads {canonical[ends[0]]:.2f} at "
            f"n = {ends[0]} and {canonical[ends[1]]:.2f} at n = {ends[1]}; of fresh canonical "
            f"steps it passes at least {passed[0]:.0%} and {passed[1]:.0%}, whoever it was trained "
            "against."
        )
    return "\n\n".join(said)
