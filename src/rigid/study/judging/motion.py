"""What people see of an episode: bodies and the itch, and nothing of what RIGID thinks of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rigid.errors import UserError
from rigid.files import json_text
from rigid.report.poses import encode_poses

_SEEN = ("dt", "frames", "bodies", "itch")
"""Forces, contacts, outcome and return would tell raters what to answer."""


def motion_text(replay: Mapping[str, Any], *, moment: int | None = None) -> bytes:
    """An episode as the page reads it (`rigid.report.payload.Replay`), as JSON.

    Args:
        replay: Of `Task.replay`.
        moment: Only this frame, for a still; None for all.

    Raises:
        UserError: The task draws nothing.
    """
    if "poses" not in replay:
        raise UserError("the study's task draws nothing of an episode, so people cannot judge it")
    frames = slice(None) if moment is None else slice(moment, moment + 1)
    poses = replay["poses"][frames]
    seen = {name: replay[name] for name in _SEEN if name in replay}
    return json_text({**seen, "frames": len(poses), "poses": encode_poses(poses)}).encode()
