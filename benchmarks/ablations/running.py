"""The study from its plan to its account."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.ablations.account import account
from benchmarks.ablations.drawing import draw
from benchmarks.ablations.humans import Parts, fixed_humans
from benchmarks.ablations.plan import Plan
from benchmarks.ablations.sizes import Reading, read_sizes, size_part
from benchmarks.ablations.summary import size_rows, variant_rows
from benchmarks.ablations.training import Point, Workplace
from benchmarks.study import say, write_table
from rigid.commands.parsing import spoken
from rigid.commands.terminal.progress import TerminalListener
from rigid.compute.budget import training_speed
from rigid.compute.listening import Workload
from rigid.compute.run.directory import alone_in, check_place, open_run
from rigid.compute.run.provenance import command_line
from rigid.files import write_atomically
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy

_COMPILING, _JUDGING, _READING = 8.0, 1.3, 1.5
"""Seconds for a variant, an adversary, and a human under one canonical set; for the estimate of
time only (measured on two cores)."""
_HUMANS = 7


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Makes what is missing in `out`, then writes everything into `results`.

    Raises:
        UserError: `out` holds parts of another plan, or cannot be written.
    """
    check_place(out)
    place = Workplace(plan, out)
    say("preparing robot, canonical episodes and the referee's folds")
    identity = place.identity()
    with alone_in(out):
        opened = open_run(out, identity, plan.preset.seeds, command_line())
        for warning in opened.warnings:
            say(warning)
        place.plan = plan.with_seeds(opened.seeds)
        found = train_variants(place)
        readings = read_all_sizes(place)
    anchor = place.prepared().canonical["adversarialness"]
    variants = variant_rows(found, plan.variants(), anchor)
    sizes = size_rows(readings)
    write_table(results / "table.csv", variants)
    write_table(results / "size.csv", sizes)
    draw(results / "figure.svg", variants, sizes)
    text = account(place.plan, variants, sizes, place.prepared())
    write_atomically(results / "README.md", text.encode())
    say(f"written: {results / 'README.md'}")


def train_variants(place: Workplace) -> dict[str, list[Point]]:
    """The adversaries of every variant, all seeds."""
    plan = place.plan
    variants = plan.variants()
    missing = [
        (variant, seed)
        for variant in variants
        for seed in plan.preset.seeds
        if not place.part(variant, seed).exists()
    ]
    per_part = len(plan.lambdas) * plan.preset.iterations * plan.preset.episodes
    steps = len(missing) * per_part * place.task.horizon
    seconds = _expected_seconds(place, [variant.name for variant, _ in missing], steps)
    say(
        f"{len(variants)} variants with {len(plan.preset.seeds)} seeds each, {len(missing)} of "
        f"{len(variants) * len(plan.preset.seeds)} parts to do, then sizes of the canonical set; "
        f"about {spoken(seconds)} in all"
    )
    with TerminalListener("training") as listener:
        if missing:
            listener.begin(
                Workload(training_steps=steps, steps=steps, steps_per_second=steps / seconds)
            )
        for variant, seed in missing:
            listener.say(f"{variant.name}, seed {seed}")
            place.points(variant, seed, listener.advance)
    return {
        variant.name: [p for seed in plan.preset.seeds for p in place.points(variant, seed)]
        for variant in variants
    }


def read_all_sizes(place: Workplace) -> list[Reading]:
    """What judges say of every human, at every size of the canonical set."""
    seed = place.plan.preset.seeds[0]
    missing = _missing_sizes(place)
    return read_sizes(place, seed, _humans(place, seed) if missing else None)


def _humans(place: Workplace, seed: int) -> Mapping[str, Parts]:
    """The default's adversaries of one seed, and humans who need no training."""
    plan, opponent = place.plan, place.prepared().opponent
    group = place.group(seed)
    adversaries = {
        f"adversary, λ = {lambda_:g}": load_policy(
            str(place.out / plan.default.name / "adversaries" / group.member(number)),
            task=place.task, agent="human",
        )
        for number, lambda_ in enumerate(plan.lambdas)
    }  # fmt: skip
    counts = (plan.sizes.train, plan.sizes.validation, plan.sizes.test)
    human = GaussianPolicy(opponent.human)
    return fixed_humans(place.task, opponent.robot, human, adversaries, counts)


def _missing_sizes(place: Workplace) -> int:
    sizes, seed = place.plan.sizes, place.plan.preset.seeds[0]
    return sum(
        not size_part(place, seed, repeat, episodes).exists()
        for repeat in range(sizes.repeats)
        for episodes in sizes.episodes
    )


def _expected_seconds(place: Workplace, parts: Sequence[str], steps: int) -> float:
    """Time for the missing parts, by name of their variant, and for what sizes are missing [s]."""
    training = steps / training_speed(place.task) if steps else 0.0
    judging = _JUDGING * len(parts) * len(place.plan.lambdas)
    readings = _READING * _HUMANS * _missing_sizes(place)
    return training + judging + _COMPILING * len(set(parts)) + readings
