"""What the study trains, measures and plays: robots, unseen humans and budgets, all from seeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Any, Literal

from benchmarks.robots import QUICK_RECIPE, RECIPE, RobotPlan
from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.learning.ppo import PPOSettings
from rigid.presets import PRESETS, Preset

Group = Literal["pairs", "bodies", "impairments"]
GROUPS: tuple[Group, ...] = ("pairs", "bodies", "impairments")


@dataclass(frozen=True, kw_only=True)
class HumanPlan:
    """A human whom no robot was trained for and no search began from."""

    name: str
    group: Group
    seed: int
    """Of the episodes that every robot plays with this human: the same starts for all."""
    pair: int | None = None
    """Seed of the co-optimised pair that it comes from; None: the own human, changed."""
    changes: Mapping[str, Any] = field(default_factory=dict)
    """Parameters of the task: another body, an impairment."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The whole study."""

    robots: tuple[RobotPlan, ...]
    pairs: tuple[int, ...]
    """Seeds of the co-optimised pairs whose humans are met."""
    pair_settings: CoOptimisationSettings
    training: PersonalisationSettings
    """Of every robot, but for iterations and noise."""
    preset: Preset
    """Budget of every frontier."""
    episodes: int
    """Fresh episodes of each robot with each human."""
    resamples: int
    """Of robots, in every bootstrap."""
    redraws: int = 1000
    """Of the search seeds of each robot, for the resamples to choose from."""
    command: str
    """Makes it all, from the root of the repository."""

    def humans(self) -> tuple[HumanPlan, ...]:
        """Everyone the robots meet, group by group."""
        seeds = count(_FIRST_SEED)
        pairs = (
            HumanPlan(name=f"pair-{pair}", group="pairs", seed=next(seeds), pair=pair)
            for pair in self.pairs
        )
        changed = (
            HumanPlan(name=name, group=group, seed=next(seeds), changes=changes)
            for name, group, changes in _CHANGED
        )
        return (*pairs, *changed)


_FIRST_SEED = 100
"""Of episodes; any number does. Ours."""
_CHANGED: tuple[tuple[str, Group, dict[str, Any]], ...] = (
    ("female", "bodies", {"body": "female"}),
    ("male-p5", "bodies", {"percentile": 5.0}),
    ("male-p95", "bodies", {"percentile": 95.0}),
    *(
        (f"{kind}-{severity:g}", "impairments", {"impairment": kind, "severity": severity})
        for kind in ("limits", "weakness", "tremor")
        for severity in (0.5, 1.0)
    ),
)

PLAN = Plan(
    command=".venv/bin/python -m benchmarks.prediction",
    robots=(
        RobotPlan(iterations=6, seed=4),
        RobotPlan(iterations=6, seed=1),
        RobotPlan(iterations=7, seed=2),
        RobotPlan(iterations=9, seed=4),
        RobotPlan(iterations=12, seed=2),
        RobotPlan(iterations=25, seed=5),
        RobotPlan(iterations=50, seed=6),
        RobotPlan(iterations=100, seed=7),
        RobotPlan(iterations=100, seed=8),
        RobotPlan(iterations=100, seed=9),
        RobotPlan(iterations=50, seed=10, std=(0.05, 0.05)),
        RobotPlan(iterations=50, seed=11, std=(0.5, 0.2)),
    ),
    pairs=(1, 2),
    pair_settings=CoOptimisationSettings(),
    training=RECIPE,
    preset=replace(PRESETS["standard"], name="prediction", seeds=(0, 1, 2)),
    episodes=200,
    resamples=4000,
)
"""The study. Budgets are ours: three seeds of preset `standard` take about four minutes a frontier
on two cores, so that a dozen robots take an hour, where preset `paper` would take ten. The short
trainings were tried: success with the own human was .05 after 5 iterations, .51 to .65 after 6, .72
after 7, .98 after 9, 1 after 12."""

_QUICK_PPO = PPOSettings(minibatch=400)
QUICK = Plan(
    command=f"{PLAN.command} --quick",
    robots=tuple(RobotPlan(iterations=length, seed=length) for length in (1, 2, 3, 4)),
    pairs=(1,),
    pair_settings=CoOptimisationSettings(iterations=2, episodes=8, ppo=_QUICK_PPO),
    training=QUICK_RECIPE,
    preset=Preset(
        name="quick",
        seeds=(0, 1),
        per_round=(2,),
        iterations=2,
        episodes=4,
        scoring_episodes=10,
        referee_episodes=8,
        validation_episodes=4,
        search_canonical=8,
        referee_canonical=12,
        stamp="quick: shows that the road works and nothing of any robot",
    ),
    episodes=10,
    resamples=200,
)
"""The same road with budgets that say nothing."""
