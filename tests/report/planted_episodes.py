"""Episodes of known cause: a robot of three bodies, a person of three, and where each was."""

from __future__ import annotations

import numpy as np

from rigid.report.episodes import read_episode

FRAMES = 101
DT = 0.1  # [s]
BODIES = (
    "world", "base", "shoulder", "elbow", "tool", "right_upper_arm", "right_forearm", "head",
)  # fmt: skip
TOOL, UPPER_ARM, FOREARM, HEAD = 4, 5, 6, 7
SHOULDER = np.array([0.0, 0.0, 0.5])
ITCH = np.array([0.4, 0.0, 0.5])  # On the forearm, and 0.4 m from the shoulder.
FORE = np.array([0.2, 0.0, 0.0])  # From the tool's tip to the elbow.
START = ITCH + (0.0, 0.2, 0.0)  # Where the tip is at first.
ARM, ITCHES, UNWANTED = 1, 0, 2

_ROLES = {"base": "robot", "shoulder": "robot", "elbow": "robot", "tool": "tool",
          "right_upper_arm": "human", "right_forearm": "human", "head": "human"}  # fmt: skip
SCENE = {
    "bodies": list(BODIES),
    "geoms": [
        {
            "name": "tip" if body == "tool" else body, "body": BODIES.index(body), "role": role,
            "type": "sphere", "size": [0.01], "pos": [0, 0, 0], "quat": [1, 0, 0, 0],
            "rgba": [1, 1, 1, 1],
        }
        for body, role in _ROLES.items()
    ],
    "rest": [[0, 0, 0, 1, 0, 0, 0] for _ in BODIES],
}  # fmt: skip
SCENE["rest"][2][:3] = SHOULDER.tolist()


def still(place=START):
    """A path that stays where it is."""
    return np.tile(np.asarray(place, float), (FRAMES, 1))


def swinging(place, step):
    """A path to and fro, `step` metres each frame."""
    path = still(place)
    path[1::2, 2] += step
    return path


def moved(path, frame, by):
    """The path, which jumps by some metres from a frame on."""
    path = path.copy()
    path[frame:] += by
    return path


def touching(frames, place, body, kind, force=2.0):
    """The tool's contacts, one for each of some frames."""
    return [[f, *np.asarray(place, float), force, kind, TOOL, body] for f in frames]


def planted(
    tip, itch=None, *, counted=(), spilled=None, contacts=(), force=(), outcome="unhelped",
    itching=FOREARM,
):  # fmt: skip
    """A replay: the tip's path, the itch's path, frames that count a contact, and what touched.

    `spilled` are frames at which food falls, in a task that has some.
    """
    itch = still(ITCH) if itch is None else itch
    poses = np.zeros((FRAMES, 3, 7))
    poses[:, :, 3] = 1
    poses[:, 0, :3], poses[:, 1, :3], poses[:, 2, :3] = tip + FORE, tip, itch
    total, forces = np.zeros(FRAMES), np.zeros(FRAMES)
    for frame in counted:
        total[frame:] += 1
    for frame, value in force:
        forces[frame] = value
    food = {} if spilled is None else {"spilled": [sum(f <= frame for f in spilled)
                                                   for frame in range(FRAMES)]}  # fmt: skip
    return {
        **food, "dt": DT, "frames": FRAMES, "bodies": [3, TOOL, itching], "poses": poses,
        "itch": {"body": itching, "pos": [0, 0, 0], "limb": "limb"},
        "distance": np.linalg.norm(tip - itch, axis=1).tolist(), "counted": total.tolist(),
        "force_unwanted": forces.tolist(), "contacts": list(contacts), "outcome": outcome,
    }  # fmt: skip


def seen(replay):
    """The episode of a replay."""
    return read_episode(SCENE, replay)


def canonical_replay(step=0.016):
    """Canonical play: the tip swings at the itch, 1.6 m in all."""
    return planted(swinging(ITCH, step), counted=range(10, 60), outcome="helped")


def canonical(step=0.016):
    """The episode of canonical play."""
    return seen(canonical_replay(step))
