"""What runs keep of adversaries: episodes that pairs may show, and canonical ones beside them."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from rigid.compute.run.checkpoint import load_arrays
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.data.pair_file import SHOWN, FoundMember, RecordedMember, Reference
from rigid.errors import UserError
from rigid.frontier.result import Frontier, load_frontier, measured_points
from rigid.tasks.protocol import Task, adversarialness
from rigid.tasks.registry import task_from_description

_CURE = "copy the run directory again, or measure again"


@dataclass(frozen=True)
class MeasuredRun:
    """A finished run of one of RIGID's own tasks."""

    frontier: Frontier
    identity: Mapping[str, Any]
    task: Task
    key: str
    """Hash of `frontier.json`: puts runs in an order that is not the user's."""

    @property
    def directory(self) -> Path:
        """Where it lies."""
        return self.frontier.directory

    @property
    def return_range(self) -> tuple[float, float]:
        """Returns that map to adversarialness 1 and 0."""
        worst, best = self.frontier.data["return_range"]
        return float(worst), float(best)


class Candidate(NamedTuple):
    """An episode that a pair may show."""

    member: FoundMember | RecordedMember
    """Its snapshot is chosen last, when the pair has a reference."""
    states: Float[np.ndarray, "T1 state"]
    """Snapshots after the reset and after each step."""


class Companion(NamedTuple):
    """Canonical play that a run keeps beside an episode of an adversary."""

    reference: Reference
    total: float
    """Its return."""
    states: Float[np.ndarray, "T1 state"]


def read_run(directory: Path) -> MeasuredRun:
    """A finished run directory.

    Raises:
        UserError: It is unfinished or damaged, or of a task that is not RIGID's own.
    """
    frontier = load_frontier(directory)
    run = RunDirectory(directory)
    identity = read_settings(run)["identity"]
    described = identity.get("task")
    task = task_from_description(described) if isinstance(described, Mapping) else None
    if task is None or not isinstance(identity.get("robot"), str):
        raise UserError(
            f"{directory} was measured on a task that is not RIGID's own, so its episodes cannot "
            "be shown: leave it out"
        )
    return MeasuredRun(
        frontier, identity, task, hashlib.sha256(run.frontier.read_bytes()).hexdigest()
    )


def found_episodes(run: MeasuredRun) -> tuple[list[Candidate], list[Companion]]:
    """What a run keeps: the worst and the median episode of each adversary that counts.

    Adversaries that fault too often to be on a frontier are left out, and so are episodes that
    faulted.

    Raises:
        UserError: A file of the run is damaged.
    """
    candidates: list[Candidate] = []
    companions: list[Companion] = []
    points = run.frontier.points
    for point, measured in zip(points, measured_points(points), strict=True):
        if not measured.is_sound:
            continue
        path = RunDirectory(run.directory).adversary(point["id"]) / "episodes.npz"
        arrays = load_arrays(path, cure=_CURE)
        try:
            for candidate, companion in _kept(point, arrays, run.return_range):
                companions.append(companion)
                if candidate is not None:
                    candidates.append(candidate)
        except (KeyError, IndexError, ValueError) as error:
            raise UserError(f"{path} is damaged ({error}): {_CURE}") from None
    return candidates, companions


def _kept(
    point: Mapping[str, Any], arrays: Mapping[str, np.ndarray], return_range: tuple[float, float]
) -> Iterator[tuple[Candidate | None, Companion]]:
    """The episodes of one adversary, each with its companion; None for one that faulted."""
    picks = arrays["shown"].tolist()
    harm = adversarialness(arrays["returns"], return_range)
    for number in range(len(set(picks))):  # With few episodes worst and median may be the same.
        episode, shown = picks[number], SHOWN[number]
        seed = int(arrays["seeds"][episode])
        companion = Companion(
            Reference(point=point["id"], shown=shown, seed=seed),
            float(arrays["canonical_returns"][number]),
            arrays["canonical_snapshots"][number],
        )
        if arrays["faulted"][episode]:
            yield None, companion
            continue
        member = FoundMember(
            point=point["id"], shown=shown, episode=episode, seed=seed,
            naturalness=float(point["naturalness"]), naturalness_se=point.get("naturalness_se"),
            adversarialness=float(harm[episode]), snapshot=0, snapshot_by="deviation",
        )  # fmt: skip
        yield Candidate(member, arrays["snapshots"][number]), companion


def starts_of(task: Task, seeds: Sequence[int]) -> Int[np.ndarray, " n"]:
    """What the human starts from, as far as naturalness sees it: equal numbers start alike.

    In itch scratching that is the limb that itches, since everybody begins in the same pose.
    """
    if not seeds:  # A run all of whose adversaries faulted.
        return np.zeros(0, dtype=int)
    world = task.make_world(len(seeds))
    seen = task.features(world.reset(np.asarray(seeds, dtype=np.int64)))
    return np.unique(seen, axis=0, return_inverse=True)[1].reshape(-1)
