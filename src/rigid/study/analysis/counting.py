"""How many people lie above a frontier, for each kind of device, and whether that says anything.

People alone: scripted players are never counted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigid.frontier.intervals import Interval, t_interval
from rigid.study.analysis.dominance import Share, share
from rigid.study.analysis.placing import Placed
from rigid.study.analysis.players import Player, harm_of, sound_of
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.analysis.scoring import upper_bound
from rigid.study.analysis.settings import AnalysisSettings
from rigid.study.records import DeviceClass


@dataclass(frozen=True, kw_only=True)
class Control:
    """Benign players of one kind of device with one robot."""

    robot: str
    device: DeviceClass
    people: int
    naturalness: float | None
    """Mean over people, of upper bounds."""
    interval: Interval | None
    adversarialness: float | None
    claim: bool
    """Whether people of this device may be held against the frontier."""
    why: str
    """In words."""


@dataclass(frozen=True, kw_only=True)
class Count:
    """How many people of one role lie above the frontier."""

    robot: str
    device: DeviceClass
    role: str
    people: Share
    clearly: int
    """How many of them by more than their own episodes scatter."""
    above_hull: int
    """How many lie above the hull as well."""
    on_device: Share
    """With x as if the device hid nothing; 0 of 0 without practice."""
    episodes_above: int
    episodes: int
    people_with_episodes_above: Share
    claim: bool


def controls_of(
    robot: MeasuredRobot, players: Sequence[Player], settings: AnalysisSettings
) -> dict[DeviceClass, Control]:
    """The control of each kind of device: people's practice with this robot."""
    found = {}
    for device in dict.fromkeys(p.device for p in players if not p.scripted):
        mine = [p for p in players if p.device == device and not p.scripted]
        bounds = [upper_bound(robot.panels, sound_of(robot, p.practised)) for p in mine]
        levels = [bound.naturalness for bound in bounds if bound is not None]
        harm = np.array([h for p in mine for h in harm_of(robot, p.practised)])
        mean = float(np.mean(levels)) if levels else None
        why = _why(mean, len(levels), settings.benign_floor)
        found[device] = Control(
            robot=robot.key, device=device, people=len(levels), naturalness=mean,
            interval=t_interval(levels, settings.confidence) if levels else None,
            adversarialness=float(harm.mean()) if len(harm) else None,
            claim=mean is not None and mean >= settings.benign_floor, why=why,
        )  # fmt: skip
    return found


def counts_of(
    robot: str, placed: Sequence[Placed], controls: Mapping[DeviceClass, Control]
) -> list[Count]:
    """For each kind of device and role; people only."""
    people = [p for p in placed if not p.player.scripted and p.unplaced is None]
    groups = dict.fromkeys((p.player.device, p.player.role) for p in people)
    found = []
    for device, role in groups:
        mine = [p for p in people if (p.player.device, p.player.role) == (device, role)]
        own = [p.above_on_device for p in mine if p.above_on_device is not None]
        found.append(Count(
            robot=robot, device=device, role=role,
            people=share([bool(p.above) for p in mine]), on_device=share(own),
            clearly=sum(bool(p.above_clearly) for p in mine),
            above_hull=sum((p.adversarialness or 0.0) > (p.hull or 0.0) for p in mine),
            episodes_above=sum(p.episodes_above or 0 for p in mine),
            episodes=sum(len(p.harm) for p in mine),
            people_with_episodes_above=share([bool(p.episodes_above) for p in mine]),
            claim=controls[device].claim,
        ))  # fmt: skip
    return found


def _why(mean: float | None, people: int, floor: float) -> str:
    if mean is None:
        return "nobody practised twice on this kind of device, so nothing tells it from the person"
    seen = f"{people} benign player(s) score {mean:.2f} on average"
    if mean < floor:
        return f"{seen}, below {floor:g}: what the referee sees there is the device"
    return f"{seen}, at least {floor:g}"
