"""Warnings of MuJoCo in environments of others."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

_SCRIPT = """
import mujoco
from rigid.tasks.bridges.once import warn_once
warn_once()
falling = "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
for speed in (1e20, 2e20, 3e20):
    model = mujoco.MjModel.from_xml_string(falling)
    data = mujoco.MjData(model)
    data.qvel[:] = speed
    mujoco.mj_step(model, data)
"""


def test_a_warning_of_many_environments_is_said_once_and_leaves_no_log_file(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", _SCRIPT], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stderr.count("MuJoCo: ") == 1
    assert "Nan, Inf or huge value" in done.stderr
    assert list(tmp_path.iterdir()) == []
