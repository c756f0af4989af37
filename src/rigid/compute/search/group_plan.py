"""Which adversaries make up a group, what they share, and how much work they are."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rigid.compute.search.scoring import Ruler
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.group_play import Opponent
from rigid.learning.searching import Search, search_for
from rigid.presets import Preset
from rigid.tasks.protocol import Task


@dataclass(frozen=True)
class GroupPlan:
    """Which adversaries make up the group."""

    seed: int
    round: int
    lambdas: tuple[float, ...]

    @property
    def name(self) -> str:
        """`s0-r1`: seed 0, round 1."""
        return f"s{self.seed}-r{self.round}"

    def member(self, index: int) -> str:
        """Id of one adversary, `s0-r1-l1` for the first λ."""
        return f"{self.name}-l{index + 1}"

    @property
    def entropy(self) -> int:
        """One integer from which all of the group's randomness derives."""
        return int(np.random.SeedSequence([self.seed, self.round]).generate_state(1)[0])


@dataclass(frozen=True)
class GroupInputs:
    """Everything that every group of a measurement shares."""

    task: Task
    opponent: Opponent
    ruler: Ruler
    preset: Preset
    settings: AdversarySettings
    directory: Path
    threads: int = 0
    """Threads that step worlds; 0: every core. No number depends on it."""


def search_of(inputs: GroupInputs, plan: GroupPlan) -> Search:
    """How the group is trained."""
    return search_for(inputs.task, inputs.opponent, inputs.settings, plan.lambdas, plan.entropy)


def training_steps(inputs: GroupInputs, plan: GroupPlan) -> int:
    """Environment steps of a group's training."""
    return inputs.preset.iterations * _steps_of_an_iteration(inputs, plan)


def all_steps(inputs: GroupInputs, plan: GroupPlan) -> int:
    """Environment steps of a group's training and scoring."""
    return training_steps(inputs, plan) + scoring_steps(inputs, plan)


def scoring_steps(inputs: GroupInputs, plan: GroupPlan) -> int:
    """Environment steps of a group's scoring."""
    return inputs.preset.scoring_steps(len(plan.lambdas), inputs.task.horizon)


def begun_steps(inputs: GroupInputs, plan: GroupPlan) -> int:
    """Environment steps that an earlier call did of a group that it did not end."""
    rows = inputs.directory / "adversaries" / plan.member(0) / "metrics.jsonl"
    if not checkpoint_of(inputs.directory, plan).exists() or not rows.exists():
        return 0
    return len(rows.read_bytes().splitlines()) * _steps_of_an_iteration(inputs, plan)


def _steps_of_an_iteration(inputs: GroupInputs, plan: GroupPlan) -> int:
    return search_of(inputs, plan).blocks * inputs.preset.episodes * inputs.task.horizon


def checkpoint_of(directory: Path, plan: GroupPlan) -> Path:
    """Exists while the group is begun and not done."""
    return directory / "groups" / f"{plan.name}.safetensors"
