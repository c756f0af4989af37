"""What a report is made of: the fields that the front end reads.

Every field may be missing or null; the page then says that it is unknown. Lengths are in [m],
forces in [N], the world's z axis points up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict


class Band(TypedDict):
    """The hull's mean over seeds and its interval, on a grid of naturalness."""

    x: Sequence[float]
    mean: Sequence[float]
    low: Sequence[float] | None
    high: Sequence[float] | None


class Passive(TypedDict):
    """An untrained human who does nothing: a reference, never an attack."""

    naturalness: float | None
    adversarialness: float | None
    success: float | None


class Learning(TypedDict, total=False):
    """One human's training, a value per iteration; `return` belongs here too."""

    iteration: Sequence[float]
    score_canonical: Sequence[float]
    score_adversary: Sequence[float]
    accuracy_canonical: Sequence[float]
    accuracy_adversary: Sequence[float]
    entropy: Sequence[float]


class Geom(TypedDict):
    """A shape on a body, as MuJoCo describes it: half-lengths, axis along z, quaternion w, x, y, z.

    `pos` and `quat` are in the body's frame.
    """

    name: str
    body: int
    type: Literal["capsule", "sphere", "box", "cylinder", "ellipsoid"]
    size: Sequence[float]
    pos: Sequence[float]
    quat: Sequence[float]
    rgba: Sequence[float]
    role: Literal["robot", "human", "chair", "tool", "floor"]


class Scene(TypedDict, total=False):
    """The bodies' names and all that is drawn.

    The tool's tip is the body "tool_tip", else the geom "tip" or "…_tip". `rest` has a pose
    x, y, z, w, x, y, z for every body; it places those that no replay moves, which are else at
    the origin.
    """

    bodies: Sequence[str]
    geoms: Sequence[Geom]
    rest: Sequence[Sequence[float]]


class Itch(TypedDict):
    """Where it itches, in the frame of a body."""

    body: int
    pos: Sequence[float]
    limb: str


class Replay(TypedDict, total=False):
    """One episode; `return` and `success` belong here too.

    `poses` is `rigid.report.encode_poses` of the moving `bodies`. A contact is frame, x, y, z,
    force and kind: 0 at the itch, 1 elsewhere on the arm, 2 unwanted.
    """

    seed: int
    dt: float
    frames: int
    bodies: Sequence[int]
    poses: str
    itch: Itch
    force_unwanted: Sequence[float]
    force_itch: Sequence[float]
    distance: Sequence[float]
    counted: Sequence[float]
    contacts: Sequence[Sequence[float]]
    outcome: Literal["helped", "unhelped", "unwanted_contact"]


class Accuracy(TypedDict):
    """Shares of steps that a judge tells right; `rigid.compute.discriminator_files.Accuracy`."""

    canonical: Sequence[float]
    adversaries: Mapping[str, float | None]


class Judged(TypedDict):
    """One human's discriminator and referee, and D of the poses, negative for canonical."""

    discriminator: Accuracy
    referee: Accuracy | None
    scores: Mapping[Literal["noisy", "own"], Sequence[object]]


class Moments(TypedDict):
    """Single moments of moving `bodies`; `poses` is `rigid.report.encode_poses` of them."""

    frames: int
    bodies: Sequence[int]
    poses: str


class Poses(TypedDict):
    """Canonical poses at each of some levels of noise, level by level, and poses of each human."""

    levels: Sequence[float]
    noisy: Moments
    own: Mapping[str, Moments]


class Discriminators(TypedDict):
    """What the discriminators of one search seed tell apart.

    `judged` is by point, and null where the search measure has no discriminator; `poses` is null
    where the task has no picture or its features tell no pose.
    """

    levels: Sequence[float]
    canonical_episodes: int
    adversary_episodes: int
    judged: Mapping[str, Judged] | None
    poses: Poses | None


class Payload(TypedDict, total=False):
    """The whole report.

    `replays` maps a point's id to {"worst": Replay, "median": Replay}, "canonical" to
    {seed: Replay} and "passive" to a Replay; a point's motion stands beside the canonical one of
    the same seed. `discriminators` is by search seed, without those that were never examined.
    """

    frontier: Mapping[str, object]
    settings: Mapping[str, object]
    stamp: str | None
    band: Band | None
    passive: Passive | None
    learning: Mapping[str, Learning] | None
    scene: Scene | None
    replays: Mapping[str, object] | None
    discriminators: Mapping[str, Discriminators] | None
