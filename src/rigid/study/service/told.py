"""What a live connection tells of an episode, and what is kept of it."""

from __future__ import annotations

import math
from typing import Any

from rigid.study.flow import NextEpisode, Position
from rigid.study.play.episode import Played, PlayedEpisode
from rigid.study.play.frame import Frame
from rigid.study.records import Participant, PlayedRecord
from rigid.study.service.messages import Begin


def announcement(
    where: Position, following: NextEpisode, episode: PlayedEpisode, first: Frame
) -> dict[str, Any]:
    """What the page needs to draw an episode and to aim."""
    return {
        "type": "episode", "kind": following.kind, "number": following.number, "of": where.of,
        "bodies": list(episode.bodies), "substeps": episode.substeps, "period": episode.period,
        "horizon": episode.horizon, "goal": episode.goal, "reach": episode.reach,
        "hand": [float(value) for value in first.hand],
    }  # fmt: skip


def acknowledgement(where: Position, following: NextEpisode, played: Played) -> dict[str, Any]:
    """Said once the episode is on disk."""
    success = None if math.isnan(played.success) else bool(played.success)
    return {
        "type": "finished", "number": following.number, "success": success,
        "done": where.done + 1, "of": where.of,
    }  # fmt: skip


def record_of(
    participant: Participant,
    following: NextEpisode,
    wish: Begin,
    played: Played,
    attempts: int,
    started: str,
) -> PlayedRecord:
    """The episode as it is stored."""
    return PlayedRecord(
        participant=participant.code, number=following.number, kind=following.kind,
        role=participant.role, robot=following.robot, device=wish.device, seed=following.seed,
        attempts=attempts, episode_return=played.episode_return, success=played.success,
        outcome=played.outcome, peak_force=played.peak_force, impulse=played.impulse,
        started=started, about_device=wish.about, arrays=played.arrays,
    )  # fmt: skip
