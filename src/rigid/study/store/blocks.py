"""Played episodes as canonical data: the format that `rigid.data` and every measurement read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from rigid.data.about import About, EpisodeNote
from rigid.data.episodes import CanonicalEpisodes
from rigid.study.plan import PlayStage, StudyPlan
from rigid.study.records import DEVICE_CLASSES, DeviceClass, Kind, Participant, PlayedRecord
from rigid.study.registration import TaskFacts


class Terms(NamedTuple):
    """What goes with every file of an export."""

    consent: str
    """What the participants agreed to, in words."""
    licence: str | None
    provenance: Mapping[str, Any]


def device_class(record: PlayedRecord, kind: Kind) -> DeviceClass:
    """Among which an episode counts; those of scripts are never among people's."""
    return "scripted" if kind == "scripted" else DEVICE_CLASSES[record.device]


def manner(plan: StudyPlan | None, record: PlayedRecord) -> str:
    """How the participant was asked to play; empty where nobody knows the plan any more."""
    if record.kind == "practise":
        return "as-watched"
    role = None if plan is None else plan.roles.get(record.role)
    if role is None or record.stage is None or record.stage >= len(role.stages):
        return ""
    stage = role.stages[record.stage]
    return stage.manner if isinstance(stage, PlayStage) else ""


def is_whole(record: PlayedRecord, facts: TaskFacts) -> bool:
    """Whether an episode has every step, none of which ran away: as canonical episodes must."""
    arrays = record.arrays
    whole = len(arrays.features) == facts.horizon and not arrays.faulted.any()
    return whole and bool(np.isfinite(arrays.features).all())


def canonical_episodes(
    records: Sequence[PlayedRecord],
    facts: TaskFacts,
    *,
    kind: Kind,
    terms: Terms,
    plan: StudyPlan | None,
) -> CanonicalEpisodes:
    """Whole episodes (`is_whole`) in one file's worth.

    Args:
        records: At least one, all with one robot on one class of devices.
        facts: Of the task.
        kind: Scripts give a synthetic source.
        terms: Under which they were given.
        plan: Tells how people were asked to play.
    """
    period = facts.control_period
    arrays = [record.arrays for record in records]
    notes = tuple(
        EpisodeNote(
            name=f"{r.participant}-{r.kind}-{r.number}", participant=r.participant,
            device=r.device, robot=r.robot, notes=manner(plan, r),
        )
        for r in records
    )  # fmt: skip
    return CanonicalEpisodes(
        features=np.stack([a.features for a in arrays]).astype(np.float32),
        observations=np.stack([a.human_observations for a in arrays]).astype(np.float32),
        actions=np.stack([a.human_actions for a in arrays]).astype(np.float32),
        seeds=np.array([r.seed for r in records], np.int64),
        returns=np.array([r.episode_return for r in records], np.float32),
        success=np.array([r.success for r in records], np.float32),
        task=facts.description,
        feature_names=facts.feature_names,
        source="recorded" if kind == "person" else "synthetic",
        provenance={**terms.provenance, "robot": records[0].robot, "block": records[0].kind},
        control_period=period,
        rewards=np.stack([a.rewards for a in arrays]).astype(np.float32),
        # A row's features are of the end of its step.
        times=np.stack([a.step_times for a in arrays]).astype(np.float64) + period,
        about=About(
            units=facts.feature_units, consent=terms.consent, licence=terms.licence, episodes=notes
        ),
    )


def consent_in_words(plan: StudyPlan | None, people: Sequence[Participant]) -> str:
    """What those in an export agreed to."""
    versions = sorted({who.consent_version for who in people if who.consent_version is not None})
    study = "a study" if plan is None else f"the study {plan.title!r}"
    agreed = f"Each agreed to take part in {study} (consent {', '.join(versions) or 'none'})"
    if all(who.sharing for who in people):
        return f"{agreed}, and separately that these data may be shared beyond it."
    return f"{agreed}, but not all to sharing: these data must stay within it."
