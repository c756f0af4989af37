"""Everybody who played, on the axes of the frontier of the robot they met.

x is an upper bound, by the strictest of the runs' referees, and called so everywhere; y is the
frontier's. Scripted players are placed alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from rigid.naturalness.panel import Panel
from rigid.naturalness.rates import Rate
from rigid.study.analysis.dominance import (
    clearly_above,
    dominated,
    episodes_above,
    height_at,
    hull_height,
)
from rigid.study.analysis.players import Player, harm_of, sound_of
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.analysis.scoring import against_block, joined, upper_bound


@dataclass(frozen=True, kw_only=True)
class Placed:
    """Where a player lies."""

    player: Player
    harm: tuple[float, ...]
    """Adversarialness of each episode that did not run away."""
    adversarialness: float | None
    """Mean over episodes: y."""
    adversarialness_se: float | None
    success: float | None
    benign: float | None
    """Naturalness of its practice, at most."""
    unplaced: str | None = None
    """Why it has no place, and nothing below; None where it has one."""
    naturalness: float | None = None
    """At most, by the strictest referee: x."""
    naturalness_se: float | None = None
    referee: str | None = None
    """Of which adversary."""
    on_device: float | None = None
    """The same bound against benign play on the same kind of device; None without any."""
    height: float | None = None
    """The worst that the search found at this naturalness or above."""
    above: bool | None = None
    """Whether no point dominates it."""
    above_clearly: bool | None = None
    """The same by more than its own episodes scatter."""
    hull: float | None = None
    """Height of the frontier's hull at its naturalness: what mixing humans attains."""
    above_on_device: bool | None = None
    """The same at the larger of both bounds: as if nothing of x were the device."""
    episodes_above: int | None = None


def place(robot: MeasuredRobot, players: Sequence[Player]) -> list[Placed]:
    """Where the players of one robot lie; blocks of practice are those of people alone."""
    blocks = {
        device: [
            sound_of(robot, p.practised) for p in players if p.device == device and p.practised
        ]
        for device in dict.fromkeys(p.device for p in players if not p.scripted)
    }
    courts = {
        device: against_block(robot.panels, joined(parts))
        for device, parts in blocks.items()
        if any(part.sound.any() for part in parts)
    }
    return [_place(robot, player, courts.get(player.device)) for player in players]


def _place(robot: MeasuredRobot, player: Player, court: Sequence[Panel] | None) -> Placed:
    episodes = sound_of(robot, player.played)
    harm = harm_of(robot, player.played)
    level = _mean_of(harm)
    practice = upper_bound(robot.panels, sound_of(robot, player.practised))
    successes = [r.success for r in player.played if not np.isnan(r.success)]
    placed = Placed(
        player=player, harm=tuple(harm.tolist()),
        adversarialness=None if level is None else level.value,
        adversarialness_se=None if level is None else level.se,
        success=float(np.mean(successes)) if successes else None,
        benign=None if practice is None else practice.naturalness,
    )  # fmt: skip
    bound = upper_bound(robot.panels, episodes)
    if bound is None or level is None:
        return replace(placed, unplaced=_unplaced(player))
    x, y = bound.naturalness, level.value
    own = None if court is None else upper_bound(court, episodes)
    larger = None if own is None else max(x, own.naturalness)
    height = height_at(robot.front.naturalness, robot.front.adversarialness, x)
    return replace(
        placed, naturalness=x, naturalness_se=bound.se, referee=robot.names[bound.referee],
        on_device=None if own is None else own.naturalness,
        height=height, above=not dominated(robot.front, x, y),
        above_clearly=clearly_above(height, harm), hull=hull_height(robot.front, x),
        above_on_device=None if larger is None else not dominated(robot.front, larger, y),
        episodes_above=episodes_above(robot.front, x, harm),
    )  # fmt: skip


def _mean_of(harm: Float[np.ndarray, " e"]) -> Rate | None:
    if not len(harm):
        return None
    se = float(harm.std(ddof=1) / len(harm) ** 0.5) if len(harm) > 1 else None
    return Rate(float(harm.mean()), se)


def _unplaced(player: Player) -> str:
    count = len(player.played)
    if count < 2:
        return f"played {count} episode(s), of which one half chooses the referee: 2 are needed"
    return "its episodes ran away"
