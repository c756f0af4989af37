"""Co-optimised pairs and personalized robots as directories on disk.

A pair's directory holds `human/` (the synthetic human), `robot/` (the expert that sees what is
hidden) and, while it trains, `checkpoint.safetensors`. A robot's directory is a native policy with
`canonical.npz` beside it. Every policy's card says how it was made.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeVar

import jax.numpy as jnp

from rigid._version import __version__
from rigid.compute.checkpoint import load_tree, save_tree
from rigid.compute.subject import CANONICAL_FILE
from rigid.data.episodes import save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.files import json_text, writing_to
from rigid.learning.cooptimisation import (
    CoOptimisationSettings,
    Pair,
    Progress,
    co_optimise,
    start_pair,
)
from rigid.learning.learner import Learner
from rigid.learning.personalisation import PersonalisationSettings, personalise, start_robot
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.native import CARD_FILE, Agent, save_policy
from rigid.tasks.protocol import Task

_CHECKPOINT_EVERY = 10  # Iterations.
_CHECKPOINT = re.compile(r"checkpoint\.safetensors|\.checkpoint\.safetensors\.\d+\.tmp")
"""A checkpoint, or what a training leaves that was killed at its very first write."""
_Learner = TypeVar("_Learner")
Report = Callable[[Progress], None]


def train_pair(
    task: Task, settings: CoOptimisationSettings, *, seed: int, out: Path, report: Report
) -> None:
    """Co-optimises a pair into `out`; an interrupted training in it goes on.

    Raises:
        UserError: `out` holds a finished pair, something else, or another training.
    """
    if (out / "human" / CARD_FILE).exists():
        raise UserError(f"{out} already holds a finished pair: choose another directory with --out")
    privileged = _privileged(task)
    made_by = _provenance("co-optimize", settings, seed)
    checkpoint = _Checkpoint(out, task, made_by)
    start = checkpoint.resume(start_pair(privileged, settings, seed))

    def after(progress: Progress, pair: Pair) -> None:
        checkpoint.keep(progress.iteration + 1, pair)
        report(progress)

    pair = co_optimise(privileged, settings, seed=seed, start=start, report=after)
    made: tuple[tuple[Agent, Learner, Task], ...] = (
        ("robot", pair.robot, privileged),
        ("human", pair.human, task),  # Last: who finds it may rely on both.
    )
    for agent, learner, world in made:
        policy = GaussianPolicy(learner.policy)
        save_policy(policy, out / agent, agent=agent, task=world.describe(), provenance=made_by)
    checkpoint.path.unlink(missing_ok=True)


def train_vanilla(
    task: Task,
    settings: PersonalisationSettings,
    *,
    pair: Path,
    seed: int,
    out: Path,
    canonical_episodes: int,
    report: Report,
) -> None:
    """The paper's Vanilla RL: a robot personalized to the human of `pair`, with canonical data.

    Raises:
        UserError: `pair` is no pair, or `out` holds a finished robot, something else or another
            training.
    """
    if (out / CARD_FILE).exists():
        raise UserError(f"{out} already holds a robot: choose another directory with --out")
    privileged = _privileged(task)
    human = _one_of(pair, "human", task)
    expert = _one_of(pair, "robot", privileged)
    made_by = _provenance("vanilla", settings, seed) | {
        "human": policy_hash(human), "expert": policy_hash(expert),
    }  # fmt: skip
    checkpoint = _Checkpoint(out, task, made_by)
    start = checkpoint.resume(start_robot(task, privileged, settings, seed))

    def after(progress: Progress, learner: Learner) -> None:
        checkpoint.keep(progress.iteration + 1, learner)
        report(progress)

    learner = personalise(
        task, privileged, expert.parameters, [human], settings,
        seed=seed, start=start, report=after,
    )  # fmt: skip
    robot = GaussianPolicy(learner.policy, memory=settings.memory)
    episodes = record(
        task, robot, human, episodes=canonical_episodes, seed=seed,
        provenance={"robot": policy_hash(robot), "human": policy_hash(human)},
    )  # fmt: skip
    save_episodes(out / CANONICAL_FILE, episodes)
    save_policy(robot, out, agent="robot", task=task.describe(), provenance=made_by)
    checkpoint.path.unlink(missing_ok=True)


def _privileged(task: Task) -> Task:
    """The task as the expert sees it; a task that hides nothing is its own."""
    reveal = getattr(task, "seeing_the_itch", None)
    return task if reveal is None else reveal()


def _provenance(recipe: str, settings: Any, seed: int) -> dict[str, Any]:
    return {"recipe": recipe, "seed": seed, "settings": asdict(settings), "rigid": __version__}


def _one_of(pair: Path, agent: Agent, task: Task) -> GaussianPolicy:
    """A policy of the pair, which has to fit the task."""
    directory = pair / agent
    if not directory.is_dir():
        raise UserError(f"{pair} holds no {agent}/: give a directory of `rigid train co-optimize`")
    policy = load_policy(str(directory), task=task, agent=agent)
    assert isinstance(policy, GaussianPolicy)  # As every native policy.
    return policy


class _Checkpoint:
    """A training that was begun in a directory, and by whom."""

    def __init__(self, out: Path, task: Task, made_by: dict[str, Any]) -> None:
        self.path = out / "checkpoint.safetensors"
        with writing_to(out):
            out.mkdir(parents=True, exist_ok=True)
            names = [entry.name for entry in out.iterdir()]
        if names and not any(_CHECKPOINT.fullmatch(name) for name in names):
            raise UserError(
                f"{out} is not empty and holds no training (no {self.path.name}): choose a new "
                "directory with --out"
            )
        # Settings as numbers, so that they fit into the same file.
        text = json_text({"task": dict(task.describe()), **made_by})
        self._fingerprint = jnp.frombuffer(hashlib.sha256(text.encode()).digest(), dtype=jnp.uint8)

    def keep(self, done: int, learner: Any) -> None:
        """Writes a checkpoint now and then."""
        if done % _CHECKPOINT_EVERY == 0:
            save_tree(self.path, (jnp.asarray(done), self._fingerprint, learner))

    def resume(self, fresh: _Learner) -> tuple[_Learner, int] | None:
        """What is there, and how many iterations it has behind it; None for nothing."""
        if not self.path.exists():
            return None
        template = (jnp.asarray(0), self._fingerprint)
        done, fingerprint = load_tree(self.path, template)
        if (fingerprint != self._fingerprint).any():
            raise UserError(
                f"{self.path} is from a training with other settings: choose another directory "
                "with --out, or the same options"
            )
        _, _, learner = load_tree(self.path, (*template, fresh))
        return learner, int(done)
