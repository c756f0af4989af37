"""What twice the λ cost: `rigid bench --growth`.

Adversaries with a network each cost twice as much; those that share networks train no longer, and
cost twice the scoring.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from rigid.compute.search.group_plan import GroupInputs, GroupPlan, search_of
from rigid.compute.search.scoring import Court, judge, score
from rigid.compute.speed.timing import in_turns, spread_of, wait_for
from rigid.frontier.largest_jump import first_lambdas
from rigid.learning.searching import Search
from rigid.presets import Preset
from rigid.tasks.protocol import World

MOST = {"paper": 2.05, "standard": 1.3}
"""Largest ratios that the presets may have. Ours."""


@dataclass
class _Group:
    """A group of so many λ in training."""

    inputs: GroupInputs
    plan: GroupPlan
    search: Search = field(init=False)
    world: World = field(init=False)
    state: Any = field(init=False)

    def __post_init__(self) -> None:
        self.search = search_of(self.inputs, self.plan)
        episodes = self.search.blocks * self.inputs.preset.episodes
        self.world = self.inputs.task.make_world(episodes)
        self.state = self.search.start()

    def iterate(self) -> None:
        """One iteration, everything included."""
        self.state, metrics = self.search.iterate(self.world, self.state)
        wait_for((self.state, metrics))

    def score(self) -> None:
        """Judges and scores the group as it is now, as at the end of its training."""
        inputs, entropy = self.inputs, self.plan.entropy
        court = Court(inputs.task, inputs.opponent, inputs.ruler, inputs.preset, inputs.settings)
        group = self.search.adversaries(self.state)
        policies = [adversary.learner.policy for adversary in group]
        score(court, group, judge(court, policies, entropy), entropy)


def time_of_twice_the_lambdas(inputs: GroupInputs, repeats: int) -> dict[str, Any]:
    """Time of one group of a preset with twice its λ, over that with its own.

    A few iterations of both are timed by turns and stand for all of them; scoring is timed whole,
    by turns as well.

    Args:
        inputs: Of the preset.
        repeats: Iterations of which the median is taken.
    """
    preset, count = inputs.preset, inputs.preset.per_round[0]
    groups = {n: _Group(inputs, _plan(preset, n)) for n in (count, 2 * count)}
    training = in_turns({str(n): group.iterate for n, group in groups.items()}, repeats)
    scoring = in_turns({str(n): group.score for n, group in groups.items()}, 1)
    once, twice = ((spread_of(training[str(n)]).median, scoring[str(n)][0]) for n in groups)
    return ratio_of(preset, count, once, twice)


def _plan(preset: Preset, count: int) -> GroupPlan:
    return GroupPlan(0, 1, tuple(first_lambdas(preset.lambda_min, preset.lambda_max, count)))


def ratio_of(
    preset: Preset, count: int, once: tuple[float, float], twice: tuple[float, float]
) -> dict[str, Any]:
    """What the preset's iterations and its scoring add up to.

    Args:
        preset: Says how many iterations there are.
        count: Number of λ in one group.
        once: Seconds of an iteration, and of scoring.
        twice: The same with twice the λ.

    Example:
        >>> from rigid.presets import PRESETS
        >>> ratio_of(PRESETS["standard"], 8, (0.5, 10.0), (0.5, 20.0))["ratio"]
        1.2
    """
    iterations = preset.iterations
    whole = [iterations * iteration + scoring for iteration, scoring in (once, twice)]
    return {
        "lambdas": [count, 2 * count],
        "iteration_s": [round(once[0], 3), round(twice[0], 3)],
        "scoring_s": [round(once[1], 2), round(twice[1], 2)],
        "training_ratio": round(twice[0] / once[0], 3),
        "ratio": round(whole[1] / whole[0], 3),
        "must_be_at_most": MOST.get(preset.name),
    }
