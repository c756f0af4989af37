"""Which robots are made and measured, with what budgets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.palm import PalmSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.learning.ppo import PPOSettings
from rigid.presets import PRESETS, Preset
from rigid.robots.gleave import GleaveSettings
from rigid.robots.palm import PalmRecipe
from rigid.robots.robust_gt import RobustSettings

RECIPES = ("vanilla", "gleave", "palm", "robust-gt")
"""Of the paper's comparison, in its order; the first is what the others are held against."""
SCOUTS = (100, 101)
"""Search seeds of the frontier that Robust GT learns from: no robot is judged by those. Two, one
for each core of a small machine. Ours."""
BODIES: Mapping[str, Mapping[str, Any]] = {
    "limits": {"impairment": "limits"},
    "weakness": {"impairment": "weakness"},
    "tremor": {"impairment": "tremor"},
    "5th percentile": {"percentile": 5.0},
    "95th percentile": {"percentile": 95.0},
    "female": {"body": "female"},
}
"""Other people than the reference person, as parameters of the task."""


@dataclass(frozen=True, kw_only=True)
class Budgets:
    """Of every training."""

    pair: CoOptimisationSettings = field(default_factory=CoOptimisationSettings)
    vanilla: PersonalisationSettings = field(default_factory=PersonalisationSettings)
    gleave: GleaveSettings = field(default_factory=GleaveSettings)
    palm: PalmRecipe = field(default_factory=PalmRecipe)
    robust: RobustSettings = field(default_factory=RobustSettings)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The experiments."""

    preset: Preset
    """Of every frontier."""
    thorough: Preset | None
    """The paper's own budget, for the first robot of each recipe; None: not at all."""
    robot_seeds: tuple[int, ...]
    command: str
    budgets: Budgets = field(default_factory=Budgets)
    canonical_episodes: int = PRESETS["standard"].search_canonical
    """Recorded with each robot, for searches to see."""
    evaluation_episodes: int = 200
    """Of each robot with each human."""
    bodies: Mapping[str, Mapping[str, Any]] = field(default_factory=lambda: BODIES)
    variants: bool = True
    """Whether the first robot is also hardened from scratch and in two rounds."""
    stamp: str = ""
    """Printed on the account."""

    @property
    def first(self) -> int:
        """The robot seed of all that is done once."""
        return self.robot_seeds[0]

    @property
    def scouting(self) -> Preset:
        """Of the frontiers that Robust GT learns from.

        The paper's own budget where it is used at all, since `standard` may find nobody between
        sabotage and canonical play.
        """
        return replace(self.thorough or self.preset, seeds=SCOUTS)


def full_plan(preset: Preset, robot_seeds: tuple[int, ...]) -> Plan:
    """All experiments with a preset."""
    listed = ",".join(map(str, robot_seeds))
    standard = preset.name == "standard"
    options = "" if standard else f" PRESET={preset.name}"
    options += "" if robot_seeds == (0, 1, 2) else f" ROBOT_SEEDS={listed}"
    return Plan(
        preset=preset, robot_seeds=robot_seeds, command=f"make paper{options}",
        thorough=PRESETS["paper"] if standard else None,
        stamp=f"\n*{preset.stamp}*\n" if preset.stamp else "",
        # Other budgets are for a look at the comparison itself.
        bodies=BODIES if standard else {}, variants=standard,
    )  # fmt: skip


def quick_plan() -> Plan:
    """The whole road in some minutes, with budgets that say nothing."""
    ppo = PPOSettings(minibatch=400, epochs=1)
    pair = CoOptimisationSettings(iterations=2, episodes=12, ppo=ppo)
    vanilla = PersonalisationSettings(
        iterations=2, episodes=8, ppo=replace(ppo, cloning_coefficient=1.0)
    )
    robust = RobustSettings(
        naturalness=(0.0, 1.0), adversaries=1, share=0.5, training=replace(vanilla, episodes=8)
    )
    return Plan(
        preset=replace(
            PRESETS["demo"], name="paper-quick", iterations=2, episodes=2, scoring_episodes=12,
            referee_episodes=10, validation_episodes=6, referee_canonical=12, search_canonical=6,
        ),
        thorough=None, robot_seeds=(0, 1), canonical_episodes=6, evaluation_episodes=6,
        command="python -m benchmarks.paper --quick",
        budgets=Budgets(
            pair=pair, vanilla=vanilla, robust=robust,
            gleave=GleaveSettings(population=pair, personalisation=vanilla),
            palm=PalmRecipe(
                diverse=pair, palm=PalmSettings(personalisation=vanilla), judged_episodes=4
            ),
        ),
        bodies={"tremor": BODIES["tremor"]},
        stamp="\n*Quick run: it says nothing about any robot.*\n",
    )  # fmt: skip
