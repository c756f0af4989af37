"""Where an episode begins; `python -m rigid.tasks.bed_bathing.starts` solves it again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bed_bathing.parameters import BedBathingParameters
from rigid.tasks.bed_bathing.scene import build_spec
from rigid.tasks.bodies import human, lying
from rigid.tasks.physics.starts import Starts

_REFERENCE = BedBathingParameters()
STARTS = Starts(
    package="rigid.tasks.bed_bathing",
    goal=np.array([-0.6, 0.2, 1.0]),  # Assistive Gym, reset.
    rotation=Rotation.from_euler("y", np.pi / 2),
    person=dict(
        zip(human.ARM_JOINTS, lying.start_angles(_REFERENCE.body_size).tolist(), strict=True)
    ),
)
"""The palm points along +x over the right arm, the pad down."""

if __name__ == "__main__":
    STARTS.store(build_spec(_REFERENCE), Path(__file__).parent)
