"""`rigid record` and `rigid evaluate`: a robot and a human at play."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from rigid.commands.parsing import at_least


@dataclass(frozen=True, kw_only=True)
class _PairOptions:
    """Who plays what."""

    task: str = "itch-scratching"
    """Registered task."""
    robot: str = "builtin:vanilla"
    """builtin:NAME or a native policy directory."""
    human: str = "builtin:synthetic-human"
    """builtin:NAME or a native policy directory."""
    episodes: int = 100
    """How many episodes."""
    seed: int = 0
    """Everything random comes from it."""


@dataclass(frozen=True, kw_only=True)
class RecordCommand(_PairOptions):
    """Record canonical episodes: what natural behaviour with this robot looks like.

    Example:
      rigid record --robot my/robot --episodes 40 --seed 0 --out canonical.npz
    """

    out: Path
    """File to write (.npz)."""

    def run(self) -> int:
        """Plays and stores the episodes."""
        from rigid.data.episodes import save_episodes
        from rigid.data.recording import record
        from rigid.files import make_room, writing_to
        from rigid.policies.loading import load_policy
        from rigid.tasks.registry import make_task

        at_least("--episodes", self.episodes, 1)
        at_least("--seed", self.seed, 0)
        make_room(self.out)
        task = make_task(self.task)
        robot = load_policy(self.robot, task=task, agent="robot")
        human = load_policy(self.human, task=task, agent="human")
        made_by = {"robot": self.robot, "human": self.human}
        found = record(
            task, robot, human, episodes=self.episodes, seed=self.seed, provenance=made_by
        )
        with writing_to(self.out):
            save_episodes(self.out, found)
        print(f"{len(found)} episodes, success {found.success.mean():.3f}: {self.out}")
        return 0


@dataclass(frozen=True, kw_only=True)
class EvaluateCommand(_PairOptions):
    """Play a robot with a human and print return, success, outcomes and forces.

    Example:
      rigid evaluate --robot builtin:vanilla --human builtin:passive --episodes 500
    """

    json: bool = False
    """Print the result as JSON."""

    def run(self) -> int:
        """Plays and prints."""
        from rigid.compute.evaluation import evaluate
        from rigid.policies.loading import load_policy
        from rigid.tasks.registry import make_task

        at_least("--episodes", self.episodes, 1)
        at_least("--seed", self.seed, 0)
        task = make_task(self.task)
        found = evaluate(
            task,
            load_policy(self.robot, task=task, agent="robot"),
            load_policy(self.human, task=task, agent="human"),
            episodes=self.episodes,
            seed=self.seed,
        )
        if self.json:
            print(json.dumps(found))
            return 0
        for name, value in found.items():
            print(f"{name:22} {_text(value)}")
        return 0


def _text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_text(share)}" for name, share in value.items())
    if value is None:
        return "unknown"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
