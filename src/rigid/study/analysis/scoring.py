"""How natural a player is at most: by the referees of the runs, and against its own device.

Mouse, touch and headset move an arm in ways of their own, and a referee that learned to tell
policies apart may take the device for the person. So practice, which is benign play on the same
kind of device, is judged as well: it says how much naturalness a harmless player keeps there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rigid.naturalness.panel import LEVELS, Jury, Panel
from rigid.naturalness.rates import rate
from rigid.naturalness.referee import log_ratio
from rigid.naturalness.strictest import UpperBound, strictest_naturalness
from rigid.naturalness.views import Episodes

_STEP = LEVELS[0].name


def upper_bound(panels: Sequence[Panel], episodes: Episodes) -> UpperBound | None:
    """`strictest_naturalness`; None where the episodes are too few or ran away from the beginning.

    Args:
        panels: Of the runs that measured the robot which this player met.
        episodes: All of one player's, of one kind.
    """
    halves = (episodes.sound[first::2] for first in (0, 1))
    if not all(half.any() for half in halves):
        return None
    return strictest_naturalness(panels, episodes)


def against_block(panels: Sequence[Panel], block: Episodes) -> list[Panel]:
    """The same referees, with a device's own canonical block in place of the run's canonical data.

    What holds of a referee's score f holds of every f and every law p: P_q[f < 0] + κ P_p[f ≥ 0]
    bounds the overlap of q with p (`rigid.naturalness.strictest`). With p the law of benign play on
    the same device, f keeps none of what both owe to the device. Ours.

    Args:
        panels: Referees of the runs.
        block: Practice on that device; at least one sound step.
    """
    return [{_STEP: _recounted(panel[_STEP], block)} for panel in panels if _STEP in panel]


def joined(parts: Sequence[Episodes]) -> Episodes:
    """Episodes of several players as one block."""
    return Episodes(
        np.concatenate([part.features for part in parts]),
        np.concatenate([part.sound for part in parts]),
    )


def _recounted(jury: Jury, block: Episodes) -> Jury:
    """A jury whose false alarms are counted on `block`."""
    ratios = np.stack([log_ratio(referee, block.features) for referee in jury.referees])
    alarms = {
        kappa: rate((ratios >= np.log(kappa)).mean(axis=0), block.sound) for kappa in jury.alarms
    }
    return Jury(jury.referees, alarms)
