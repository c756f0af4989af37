"""Training every variant, and judging all adversaries by one recipe on the default features."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import jax

from benchmarks.ablations.humans import Parts, parts_of
from benchmarks.ablations.plan import HUMAN, ROBOT, TASK, Plan, Variant
from benchmarks.study import once
from rigid.compute.endings import measure
from rigid.compute.playing import play_with
from rigid.compute.preparation import Prepared, prepare
from rigid.compute.search.convergence import convergence
from rigid.compute.search.group import train_group
from rigid.compute.search.group_plan import GroupInputs, GroupPlan
from rigid.compute.subject import Subject
from rigid.learning.group_play import group_actor, phase_rng
from rigid.naturalness.features import DEFAULT
from rigid.naturalness.panel import AXIS, LEVELS, Fold, Panel, naturalness, train_panel
from rigid.naturalness.rates import Rate
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.gaussian import GaussianParameters
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.registry import make_task

Point = dict[str, Any]
"""One adversary: λ, naturalness, adversarialness and how its training went."""


class Workplace:
    """The directory of raw runs: one for each variant, with the policies; and `sizes/`."""

    def __init__(self, plan: Plan, out: Path) -> None:
        task = make_task(TASK)
        assert isinstance(task, ItchScratching)
        self.plan, self.out, self.task = plan, out, task
        self._prepared: dict[str, Prepared] = {}

    def prepared(self, features: str = DEFAULT) -> Prepared:
        """Robot, human, canonical episodes and referee's folds, seen through `features`."""
        if features not in self._prepared:
            subject = Subject(self.task, ROBOT, HUMAN, features=features)
            plan = self.plan
            self._prepared[features] = prepare(subject, plan.preset, plan.default.settings)
        return self._prepared[features]

    def identity(self) -> dict[str, Any]:
        """All that decides the numbers, as JSON."""
        plan = self.plan
        identity = {
            **self.prepared().identity,
            "lambdas": plan.lambdas,
            "variants": {variant.name: variant.describe() for variant in plan.variants()},
            "sizes": asdict(plan.sizes),
        }
        return dict(json.loads(json.dumps(identity)))  # As it is read back: lists for tuples.

    def group(self, seed: int) -> GroupPlan:
        """The adversaries of one seed."""
        return GroupPlan(seed, 1, self.plan.lambdas)

    def part(self, variant: Variant, seed: int) -> Path:
        """Where it stands how the adversaries of one variant and seed did."""
        return self.out / variant.name / f"s{seed}.json"

    def points(
        self, variant: Variant, seed: int, advance: Callable[[int], None] = lambda _: None
    ) -> list[Point]:
        """The adversaries of one variant and seed; trained and judged where nobody did."""
        found: list[Point] = once(
            self.part(variant, seed), lambda: self._train(variant, seed, advance)
        )
        return found

    def _train(self, variant: Variant, seed: int, advance: Callable[[int], None]) -> list[Point]:
        seen, plan = self.prepared(variant.features), self.group(seed)
        directory = self.out / variant.name
        inputs = GroupInputs(
            seen.task, seen.opponent, seen.ruler, self.plan.preset, variant.settings, directory
        )
        group, history = train_group(inputs, plan, advance)
        policies = [adversary.learner.policy for adversary in group]
        judged = self._judge(policies, plan.entropy)
        (directory / "groups" / f"{plan.name}.safetensors").unlink(missing_ok=True)
        return [
            {"seed": seed, "lambda": lambda_, **scores, **convergence(rows)}
            for lambda_, scores, rows in zip(plan.lambdas, judged, history, strict=True)
        ]

    def _judge(self, policies: Sequence[GaussianParameters], entropy: int) -> list[Point]:
        """Plays adversaries of whatever variant again and judges them on the default features."""
        common, preset = self.prepared(), self.plan.preset
        counts = (preset.referee_episodes, preset.validation_episodes, preset.scoring_episodes)
        rng = phase_rng(entropy, "referee")
        starts = rng.integers(2**31, size=sum(counts))
        actor = group_actor(policies, rng)
        robot = common.opponent.robot
        played = play_with(common.task, robot, actor, starts, humans=len(policies))
        ruler, everything = common.ruler, slice(None)
        points = []
        for number in range(len(policies)):
            own = parts_of(played, counts, number)
            key = jax.random.fold_in(jax.random.key(entropy), number)
            rate = judged_by(referee_of(ruler.folds, own, ruler.settings, key), own)
            found = measure(own.ended, everything, common.task, ruler.return_range)
            kept = ("adversarialness", "return", "success", "episodes", "faults")
            points.append({
                "naturalness": rate.value, "naturalness_se": rate.se,
                **{name: found[name] for name in kept},
            })  # fmt: skip
        return points


def referee_of(
    folds: Sequence[Fold], human: Parts, settings: RefereeSettings, key: jax.Array
) -> Panel:
    """Referees of single steps, which are the axis; None where all episodes ran away at once."""
    return train_panel(folds, human.train, human.validation, settings, key, LEVELS[:1])


def judged_by(panel: Panel, human: Parts) -> Rate:
    """What they say of the human's other episodes; 0 of one of whom nothing is known."""
    return naturalness(panel, human.test)[AXIS] or Rate(0.0, None)
