"""What a report is made of: the fields that the front end reads.

Every field may be missing or null; the page then says that it is unknown. Lengths are in [m],
forces in [N], the world's z axis points up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

from rigid.report.failure_kinds import Kind


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


class Keypoint(TypedDict):
    """A point whose trajectory tells how an episode went, in the frame of a body."""

    name: str
    body: int
    pos: Sequence[float]


class Scene(TypedDict, total=False):
    """The bodies' names and all that is drawn.

    The tool's tip is the body "tool_tip", else the geom "tip" or "…_tip". `rest` has a pose
    x, y, z, w, x, y, z for every body; it places those that no replay moves, which are else at
    the origin. `keypoints` are what `rigid export --keypoints` follows; without them, the tip and
    the human's moving parts. `goal` is what the tool is to reach, in a word for readers; "itch"
    where a task does not say.
    """

    bodies: Sequence[str]
    geoms: Sequence[Geom]
    rest: Sequence[Sequence[float]]
    keypoints: Sequence[Keypoint]
    goal: str


class Itch(TypedDict):
    """Where it itches, or whatever else the tool is to reach, in the frame of a body."""

    body: int
    pos: Sequence[float]
    limb: str


class Failure(TypedDict):
    """What went wrong in an episode, and when [s] it showed.

    `part` is the person's, where kinds are told apart by it; `says` is for readers.
    """

    kind: Kind
    part: str | None
    frame: int
    time: float
    says: str


class Replay(TypedDict, total=False):
    """One episode; `return` and `success` belong here too.

    `poses` is `rigid.report.encode_poses` of the moving `bodies`. A contact is frame, x, y, z,
    force, kind (0 where it is wanted, on the limb that itches, 1 elsewhere on the arms, 2
    unwanted), and the bodies of robot and person, where the task tells them. `counted` are contacts
    so far, `eaten` and `spilled` pieces of food, each where the task has such. `failure` is null
    for a helped episode, and where the task tells too little.
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
    eaten: Sequence[float]
    spilled: Sequence[float]
    contacts: Sequence[Sequence[float]]
    outcome: Literal["helped", "unhelped", "unwanted_contact"]
    failure: Failure | None


class Accuracy(TypedDict):
    """Shares of steps that a judge tells right, as `rigid.compute.search` finds them."""

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


class FailureExample(TypedDict):
    """An episode that shows a mode: of the point `id`, its worst or its median one."""

    id: str
    episode: Literal["worst", "median"]
    naturalness: float
    frame: int
    time: float
    says: str


class FailureMode(TypedDict):
    """Failures of one kind (and one part of the person), over all humans found.

    `share` of all episodes is an estimate: of each human two episodes are looked at, and its
    outcomes are split over those of them that ended alike. `points` begin with the most natural.
    """

    kind: Kind
    part: str | None
    title: str
    meaning: str
    points: Sequence[str]
    naturalness: Sequence[float]
    share: float
    example: FailureExample


class FailureModes(TypedDict):
    """How the `humans` found make the robot fail, the modes of the most natural first.

    `unseen` is the share of episodes that failed in ways that no episode looked at shows.
    """

    humans: int
    modes: Sequence[FailureMode]
    unseen: float


class Payload(TypedDict, total=False):
    """The whole report.

    `replays` maps a point's id to {"worst": Replay, "median": Replay}, "canonical" to
    {seed: Replay} and "passive" to a Replay; a point's motion stands beside the canonical one of
    the same seed. `lacking` is `rigid.frontier.result.lacking` of the headline, null where every
    seed found a human that natural. `discriminators` is by search seed, without those that were
    never examined; `failures` is null where the task tells too little of its episodes.
    """

    frontier: Mapping[str, object]
    settings: Mapping[str, object]
    stamp: str | None
    band: Band | None
    passive: Passive | None
    lacking: str | None
    learning: Mapping[str, Learning] | None
    scene: Scene | None
    replays: Mapping[str, object] | None
    discriminators: Mapping[str, Discriminators] | None
    failures: FailureModes | None
