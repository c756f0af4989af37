"""What all recipes share: trainings that can stop and go on, and what they leave on disk.

A robot's directory is a native policy with `canonical.npz` beside it; while it trains,
`checkpoint.safetensors`. Every policy's card says how it was made.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Collection
from dataclasses import asdict
from pathlib import Path
from typing import Any, Protocol, TypeVar, runtime_checkable

import jax.numpy as jnp
import numpy as np

from rigid._version import __version__
from rigid.compute.run.checkpoint import load_tree, save_tree
from rigid.compute.subject import CANONICAL_FILE
from rigid.data.episodes import save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.files import json_text, writing_to
from rigid.learning.cooptimisation import Progress
from rigid.policies.architecture import NativePolicy
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.native import CARD_FILE, Agent, load_card, save_policy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task

_NAME = "checkpoint.safetensors"
_CHECKPOINT_EVERY = 10  # Iterations.
_CHECKPOINT = re.compile(r"checkpoint\.safetensors|\.checkpoint\.safetensors\.\d+\.tmp")
"""A checkpoint, or what a training leaves that was killed at its very first write."""
_Learner = TypeVar("_Learner")


@runtime_checkable
class Report(Protocol):
    """Told how a training goes on."""

    def begin(self, task: Task, episodes: int, done: int) -> None:
        """It begins, or goes on.

        Args:
            task: Where it plays.
            episodes: Of an iteration.
            done: Iterations that earlier calls have done.
        """

    def watch(self, task: Task) -> Task:
        """The same task, of whose steps it wants to hear."""

    def __call__(self, progress: Progress) -> None:
        """An iteration is done."""


class Checkpoint:
    """A training that was begun in a directory, and by whom."""

    def __init__(
        self, out: Path, task: Task, made_by: dict[str, Any], *, beside: Collection[str] = ()
    ) -> None:
        """Makes `out` if it is missing.

        Args:
            out: Directory of the training.
            task: Where it trains.
            made_by: Recipe, seed and settings; another training's checkpoint is refused.
            beside: Names of what the recipe itself puts into `out` before this training.

        Raises:
            UserError: `out` cannot be written, or holds something else.
        """
        self.path = out / _NAME
        open_training(out, beside)
        # Settings as numbers, so that they fit into the same file.
        text = json_text({"task": dict(task.describe()), **made_by})
        self._fingerprint = jnp.frombuffer(hashlib.sha256(text.encode()).digest(), dtype=jnp.uint8)

    def keep(self, done: int, learner: Any) -> None:
        """Writes a checkpoint now and then."""
        if done % _CHECKPOINT_EVERY == 0:
            save_tree(self.path, (jnp.asarray(done), self._fingerprint, learner))

    def keeping(self, report: Report) -> Callable[[Progress, Any], None]:
        """What a training calls after every iteration: keeps the learner, then reports."""

        def after(progress: Progress, learner: Any) -> None:
            self.keep(progress.iteration + 1, learner)
            report(progress)

        return after

    def resume(self, fresh: _Learner) -> tuple[_Learner, int]:
        """What is there, and how many iterations it has behind it; else `fresh` and 0.

        Raises:
            UserError: It is damaged, or another training's.
        """
        if not self.path.exists():
            return fresh, 0
        template = (jnp.asarray(0), self._fingerprint)
        done, fingerprint = load_tree(self.path, template)
        if (fingerprint != self._fingerprint).any():
            raise UserError(
                f"{self.path} is from a training with other settings: choose another directory "
                "with --out, or the same options"
            )
        _, _, learner = load_tree(self.path, (*template, fresh))
        return learner, int(done)

    def drop(self) -> None:
        """The training is over and its result stored."""
        self.path.unlink(missing_ok=True)


def open_training(out: Path, beside: Collection[str] = ()) -> None:
    """Makes the directory of a training, or finds one that was begun there.

    Args:
        out: The directory.
        beside: Names of what a recipe itself puts there.

    Raises:
        UserError: It cannot be written, or holds something else.
    """
    with writing_to(out):
        out.mkdir(parents=True, exist_ok=True)
        names = [entry.name for entry in out.iterdir()]
    if names and not any(_CHECKPOINT.fullmatch(name) or name in beside for name in names):
        raise UserError(
            f"{out} is not empty and holds no training (no {_NAME}): choose a new "
            "directory with --out"
        )


def privileged_view(task: Task) -> Task:
    """The task as the expert sees it; a task that hides nothing is its own."""
    reveal = getattr(task, "seeing_the_itch", None)
    return task if reveal is None else reveal()


def provenance(recipe: str, settings: Any, seed: int) -> dict[str, Any]:
    """The part of a card that says how a policy was made."""
    return {"recipe": recipe, "seed": seed, "settings": asdict(settings), "rigid": __version__}


def stream_of(seed: int, name: str) -> int:
    """The seed of a training beside the pair's, so that its humans are strangers to the pair's.

    With the pair's own seed a second co-optimisation would begin with the first's networks and
    episodes, and its humans would end as their relatives.

    Args:
        seed: Of the robot, which often is that of its pair.
        name: Of the training.

    Returns:
        A seed below 2**32, of which the same `seed` and `name` give the same.
    """
    return int(np.random.SeedSequence([seed, *name.encode()]).generate_state(1)[0])


def already_made(place: Path, task: Task, made_by: dict[str, Any]) -> bool:
    """Whether an earlier stage's policy lies there, of the same task and making.

    Raises:
        UserError: One of another task or making lies there, or a damaged one.
    """
    if not (place / CARD_FILE).exists():
        return False
    card = load_card(place)
    if json_text({"task": dict(card.task), **card.provenance}) != json_text(
        {"task": dict(task.describe()), **made_by}
    ):
        raise UserError(
            f"{place} is from a training with other settings: choose another directory with --out, "
            "or the same options"
        )
    return True


def refuse_finished(out: Path) -> None:
    """Keeps a finished robot from being trained over.

    Raises:
        UserError: `out` holds one.
    """
    if (out / CARD_FILE).exists():
        raise UserError(f"{out} already holds a robot: choose another directory with --out")


def one_of_pair(pair: Path, agent: Agent, task: Task) -> GaussianPolicy:
    """A policy of a pair, which has to fit the task.

    Raises:
        UserError: `pair` is none, or its policy does not fit.
    """
    directory = pair / agent
    if not directory.is_dir():
        raise UserError(f"{pair} holds no {agent}/: give a directory of `rigid train co-optimize`")
    policy = load_policy(str(directory), task=task, agent=agent)
    if not isinstance(policy, GaussianPolicy):
        raise UserError(
            f"{directory} holds a {type(policy).__name__}, as no pair does: give a directory of "
            "`rigid train co-optimize`"
        )
    return policy


def store_robot(
    robot: NativePolicy,
    human: Policy,
    task: Task,
    *,
    out: Path,
    seed: int,
    canonical_episodes: int,
    made_by: dict[str, Any],
) -> None:
    """Records canonical episodes with the robot's own human, then stores both.

    Args:
        robot: Finished.
        human: Its synthetic human.
        task: Where they play.
        out: Directory of the robot.
        seed: Of the episodes.
        canonical_episodes: How many.
        made_by: For the robot's card.
    """
    hashes = {"robot": policy_hash(robot), "human": policy_hash(human)}
    episodes = record(task, robot, human, episodes=canonical_episodes, seed=seed, provenance=hashes)
    save_episodes(out / CANONICAL_FILE, episodes)
    save_policy(robot, out, agent="robot", task=task.describe(), provenance=made_by)
