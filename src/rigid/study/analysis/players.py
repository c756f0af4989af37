"""Whose episodes belong together: one player, one robot, one kind of device."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from jaxtyping import Float

from rigid.naturalness.views import Episodes
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.records import DEVICE_CLASSES, DeviceClass, Participant, PlayedRecord
from rigid.tasks.protocol import adversarialness


@dataclass(frozen=True, kw_only=True)
class Player:
    """The episodes of one player with one robot on one kind of device."""

    code: str
    scripted: bool
    name: str
    """What a plot calls it: the script of a scripted player, else the code."""
    role: str
    robot: str
    device: DeviceClass
    practised: tuple[PlayedRecord, ...]
    played: tuple[PlayedRecord, ...]


def players_of(
    episodes: Iterable[PlayedRecord], participants: Mapping[str, Participant]
) -> list[Player]:
    """Groups episodes by player, robot and kind of device; the order is that of the codes."""

    def key(record: PlayedRecord) -> tuple[str, str, DeviceClass]:
        kind = participants[record.participant].kind
        device = "scripted" if kind == "scripted" else DEVICE_CLASSES[record.device]
        return record.robot, record.participant, device

    ordered = sorted(episodes, key=lambda record: (*key(record), record.number))
    players = []
    for (robot, code, device), group in groupby(ordered, key=key):
        records = list(group)
        scripted = device == "scripted"
        script = records[0].about_device.get("script")
        players.append(Player(
            code=code, scripted=scripted, robot=robot, device=device, role=records[0].role,
            name=str(script) if scripted and script else code,
            practised=tuple(record for record in records if record.kind == "practise"),
            played=tuple(record for record in records if record.kind == "play"),
        ))  # fmt: skip
    return players


def sound_of(robot: MeasuredRobot, records: Sequence[PlayedRecord]) -> Episodes:
    """What the referees see of episodes; those that ran away end early, and are filled up."""
    shape = len(records), robot.task.horizon
    features = np.zeros((*shape, len(robot.features.names)), np.float32)
    sound = np.zeros(shape, dtype=bool)
    for number, record in enumerate(records):
        a = record.arrays
        seen = robot.features.of(a.features, a.human_observations, a.human_actions)
        features[number, : len(seen)] = seen
        sound[number, : len(seen)] = ~a.faulted
    return Episodes(features, sound)


def harm_of(robot: MeasuredRobot, records: Sequence[PlayedRecord]) -> Float[np.ndarray, " e"]:
    """Adversarialness of the episodes that did not run away."""
    returns = [
        record.episode_return for record in records
        if np.isfinite(record.episode_return) and not record.arrays.faulted.any()
    ]  # fmt: skip
    return adversarialness(np.array(returns, dtype=float), robot.return_range)
