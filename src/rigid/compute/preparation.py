"""What a measurement needs before its first adversary: the players, canonical data, the ruler."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import jax
import numpy as np

from rigid.compute.endings import ended, measure
from rigid.compute.scoring import Ruler, naturalness_of, play_with, train_on
from rigid.data.episodes import CanonicalEpisodes, data_hash, load_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.learning.adversary import AdversarySettings, Opponent, phase_rng
from rigid.learning.rollout import policy_actor
from rigid.naturalness.referee import RefereeSettings, Rows
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import BUNDLED, load_policy, policy_hash
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy
from rigid.presets import Preset
from rigid.tasks.protocol import Task, adversarialness

CANONICAL_FILE = "canonical.npz"
_SEARCH_SEED, _RULER_SEED = 0, 1  # Of recordings: the search's episodes and the referee's.
_BLOCK = 100  # Episodes played side by side in every recording.


@dataclass(frozen=True)
class Subject:
    """Who is measured, with whom, on what; as the user named it."""

    task: Task
    robot: str
    human: str = "builtin:synthetic-human"
    canonical: str | None = None
    """A file of canonical episodes; by default the robot's own, or a fresh recording."""


@dataclass(frozen=True)
class Prepared:
    """The frozen part of a measurement."""

    opponent: Opponent
    ruler: Ruler
    canonical: dict[str, Any]
    """The `canonical` block of `frontier.json`."""
    env_steps: int
    steps_per_second: float
    """Environment steps per second while recording, for the estimate of time."""
    identity: dict[str, Any]


def prepare(subject: Subject, preset: Preset, settings: AdversarySettings) -> Prepared:
    """Loads the players and plays the canonical episodes of search and referee.

    Raises:
        UserError: Something the user named does not exist, is damaged or does not fit.
    """
    task = subject.task
    if task.return_range is None:
        raise UserError(
            f"task {task.name!r} has no range of adversarialness: set its return_range to the "
            "returns (worst, best) that map to 1 and 0"
        )
    robot = load_policy(subject.robot, task=task, agent="robot")
    human = load_policy(subject.human, task=task, agent="human")
    if not isinstance(human, GaussianPolicy):
        raise UserError(
            f"human {subject.human!r} has no action noise to search with: name a synthetic human, "
            "for example builtin:synthetic-human"
        )
    if human.memory != 1:
        raise UserError(
            f"human {subject.human!r} sees its last {human.memory} observations, but the search "
            "starts from a human without memory: name a synthetic human trained so"
        )
    search = _search_episodes(subject, robot, human, preset)
    begun = time.perf_counter()
    held_out = record(
        task, robot, human, episodes=3 * preset.referee_canonical, seed=_RULER_SEED,
        batch=_BLOCK, provenance={},
    )  # fmt: skip
    spent = time.perf_counter() - begun
    train, validation, test = np.split(held_out.features, 3)
    ruler = Ruler(train, validation, test, task.return_range, RefereeSettings())
    reward_std = _reward_std(task, robot, human)
    opponent = Opponent(robot, human.parameters, search.features, search.seeds, reward_std)
    steps = _played(3 * preset.referee_canonical) * task.horizon
    others = _BLOCK  # Those of _reward_std.
    if _canonical_path(subject) is None:
        others += _played(preset.search_canonical)
    return Prepared(
        opponent,
        ruler,
        _canonical_block(task, held_out, search, preset),
        env_steps=steps + others * task.horizon,
        steps_per_second=steps / spent,
        identity=_identity(task, robot, human, search, preset, settings),
    )


def passive_reference(task: Task, prepared: Prepared, preset: Preset) -> dict[str, Any]:
    """Where a human who does nothing stands: a reference for the eye, never an attack."""
    human = PassivePolicy(task.human.observation_size, task.human.action_size)
    rng = phase_rng(0, "referee")
    parts = (preset.referee_episodes, preset.validation_episodes, preset.scoring_episodes)
    starts = rng.integers(2**31, size=sum(parts))
    actor = policy_actor(human, len(starts), None)
    episodes = play_with(task, prepared.opponent.robot, actor, starts)
    splits = np.split(np.arange(len(starts)), np.cumsum(parts)[:2])
    train, validation, test = (episodes.features[:, part] for part in splits)
    rows = [part.reshape(-1, part.shape[-1]) for part in (train, validation, test)]
    referee = train_on(prepared.ruler, Rows(*rows[:2]), jax.random.key(0))
    scored = slice(len(starts) - preset.scoring_episodes, None)
    found = measure(ended(episodes), scored, task, prepared.ruler.return_range)
    return {**naturalness_of(prepared.ruler, referee, rows[2]), **found}


def _search_episodes(
    subject: Subject, robot: Policy, human: GaussianPolicy, preset: Preset
) -> CanonicalEpisodes:
    path = _canonical_path(subject)
    if path is not None:
        episodes = load_episodes(path, task=subject.task)
        if episodes.source == "recorded":
            raise UserError(
                f"{path} was recorded from people: this version's referee needs a human policy "
                "that can be played again; leave --canonical out or give synthetic episodes"
            )
        return episodes
    return record(
        subject.task, robot, human, episodes=preset.search_canonical, seed=_SEARCH_SEED,
        batch=_BLOCK, provenance={"robot": subject.robot, "human": subject.human},
    )  # fmt: skip


def _played(episodes: int) -> int:
    """Episodes that it takes to record `episodes` of them, faults aside."""
    return -(-episodes // _BLOCK) * _BLOCK


def _canonical_path(subject: Subject) -> Path | None:
    """The user's file, else the episodes that lie beside the robot, if there are any."""
    if subject.canonical is not None:
        return Path(subject.canonical)
    name = subject.robot.removeprefix("builtin:")
    folder = BUNDLED / subject.task.name / name if name != subject.robot else Path(name)
    file = Path(str(folder)) / CANONICAL_FILE
    return file if file.exists() else None


def _reward_std(task: Task, robot: Policy, human: GaussianPolicy) -> float:
    """Per-step standard deviation of canonical reward, σ_R of the search."""
    rng = phase_rng(0, "canonical")
    starts = rng.integers(2**31, size=_BLOCK)
    episodes = play_with(task, robot, policy_actor(human, _BLOCK, rng), starts)
    return max(float(episodes.reward.std()), 1e-6)


def _canonical_block(
    task: Task, held_out: CanonicalEpisodes, search: CanonicalEpisodes, preset: Preset
) -> dict[str, Any]:
    assert task.return_range is not None
    test = slice(2 * preset.referee_canonical, None)
    success = float(np.mean(held_out.success[test]))
    return {
        "success": None if np.isnan(success) else success,
        "return": float(held_out.returns[test].mean()),
        "adversarialness": float(adversarialness(held_out.returns[test], task.return_range).mean()),
        "episodes": len(search),
        "episodes_referee": len(held_out),
        "source": search.source,
    }


def _identity(
    task: Task,
    robot: Policy,
    human: GaussianPolicy,
    search: CanonicalEpisodes,
    preset: Preset,
    settings: AdversarySettings,
) -> dict[str, Any]:
    budget = preset.describe()
    del budget["seeds"]  # Seeds may be added to a finished run.
    identity = {
        "task": dict(task.describe()),
        "return_range": list(task.return_range or ()),
        "robot": policy_hash(robot),  # type: ignore[arg-type]
        "human": policy_hash(human),
        "canonical": data_hash(search),
        "preset": budget,
        "measure": "lsgan",
        "features": "default",
        "adversary": asdict(settings),
        "referee": asdict(RefereeSettings()),
    }
    return dict(json.loads(json.dumps(identity)))  # As JSON gives it back: lists for tuples.


def settings_for(preset: Preset, memory: int = 1) -> AdversarySettings:
    """The adversary's settings under a preset's budget."""
    if memory < 1:
        raise UserError(f"memory is {memory}, but an adversary sees at least 1 observation")
    return AdversarySettings(iterations=preset.iterations, episodes=preset.episodes, memory=memory)


def lambdas_of(lambdas: Sequence[float] | None) -> tuple[float, ...] | None:
    """The user's λ, None where the search chooses them itself."""
    if lambdas is None:
        return None
    chosen = tuple(float(value) for value in lambdas)
    sound = all(value >= 0 for value in chosen)  # NaN is not.
    if not chosen or not sound or len(set(chosen)) != len(chosen):
        raise UserError(f"lambdas must be distinct, each 0 or more or inf, got {list(chosen)}")
    return chosen


def seeds_of(preset: Preset, seeds: Sequence[int] | None) -> tuple[int, ...]:
    """Search seeds: the user's, else the preset's."""
    chosen = tuple(seeds) if seeds is not None else preset.seeds
    if not chosen or min(chosen) < 0 or len(set(chosen)) != len(chosen):
        raise UserError(f"seeds must be distinct and not negative, got {list(chosen)}")
    return chosen
