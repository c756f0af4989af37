"""What makes two measurements the same: equal identities give equal numbers."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from rigid.data.episodes import CanonicalEpisodes, data_hash
from rigid.learning.adversary_settings import AdversarySettings
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import policy_hash
from rigid.policies.protocol import Policy
from rigid.presets import Preset
from rigid.tasks.protocol import Task


def identity_of(
    task: Task,
    robot: Policy,
    human: GaussianPolicy,
    canonical: CanonicalEpisodes,
    preset: Preset,
    settings: AdversarySettings,
) -> dict[str, Any]:
    """What is measured, with what, but for the features that naturalness sees."""
    return _as_json({
        "task": dict(task.describe()),
        "return_range": list(task.return_range or ()),
        "robot": policy_hash(robot),
        "human": policy_hash(human),
        "canonical": data_hash(canonical),
        **settings_identity(preset, settings),
    })  # fmt: skip


def settings_identity(preset: Preset, settings: AdversarySettings) -> dict[str, Any]:
    """The part of a measurement's identity that its settings make up."""
    budget = preset.describe()
    del budget["seeds"]  # Seeds may be added to a finished run.
    training = asdict(settings)
    return _as_json({
        "preset": budget,
        "measure": training.pop("measure"),
        "adversary": training,
        "referee": asdict(RefereeSettings()),
    })  # fmt: skip


def _as_json(value: dict[str, Any]) -> dict[str, Any]:
    """As JSON gives it back: lists for tuples."""
    return dict(json.loads(json.dumps(value)))
