"""Where an episode begins; `python -m rigid.tasks.itch_scratching.starts` solves it again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import human
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.scene import build_spec
from rigid.tasks.physics.starts import Starts

STARTS = Starts(
    package="rigid.tasks.itch_scratching",
    goal=np.array([-0.6, 0.0, 0.8]),  # Assistive Gym, reset.
    rotation=Rotation.from_euler("y", np.pi / 2),
    person=dict(zip(human.ARM_JOINTS, human.start_angles(), strict=True)),
)
"""The palm points along +x, at the right arm of the seated person."""

if __name__ == "__main__":
    STARTS.store(build_spec(ItchScratchingParameters()), Path(__file__).parent)
