"""Where an episode begins; `python -m rigid.tasks.feeding.starts` solves it again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.scene import build_spec
from rigid.tasks.physics.starts import Starts

STARTS = Starts(
    package="rigid.tasks.feeding",
    goal=np.array([-0.15, -0.65, 1.15]),  # Over the bowl (Assistive Gym, reset).
    rotation=Rotation.from_euler("xyz", (np.pi / 2, 0, np.pi / 2)),
)
"""The palm points along +x, the spoon along +y to the person, its bowl up; the person looks
straight ahead."""

if __name__ == "__main__":
    STARTS.store(build_spec(FeedingParameters()), Path(__file__).parent)
