"""Every robot with every human: who helps whom."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigid.compute.evaluation import evaluate
from rigid.compute.unseen import UNSEEN_SEED
from rigid.frontier.successes import Played, Success, success_of
from rigid.policies.loading import load_policy
from rigid.policies.passive import PassivePolicy
from rigid.tasks.protocol import Task

PASSIVE = "passive"
"""Does nothing: a reference, no attack."""


@dataclass(frozen=True)
class Player:
    """A robot or human by recipe and robot seed."""

    name: str
    seed: int
    policy: Path


def play_all(
    task: Task, robots: Sequence[Player], humans: Sequence[Player], episodes: int
) -> list[dict[str, Any]]:
    """A row for each robot with each human, the passive one last.

    Args:
        task: Where they play.
        robots: Native policies.
        humans: Native policies; `human` with the robot's seed is its synthetic human.
        episodes: Of each pair.
    """
    everybody = [
        *((h.name, h.seed, load_policy(str(h.policy), task=task, agent="human")) for h in humans),
        (PASSIVE, -1, PassivePolicy(task.human.observation_size, task.human.action_size)),
    ]
    rows = []
    for robot in robots:
        acting = load_policy(str(robot.policy), task=task, agent="robot")
        for name, seed, human in everybody:
            found = evaluate(task, acting, human, episodes=episodes, seed=UNSEEN_SEED)
            rows.append({
                "robot": robot.name, "robot_seed": robot.seed, "human": name,
                "human_seed": seed, "success": found["success"], "return": found["return"],
                "episodes": episodes,
            })  # fmt: skip
    return rows


def own_success(
    rows: Sequence[Mapping[str, Any]], robot: str, seeds: Collection[int]
) -> Success | None:
    """Success of these of a recipe's robots with their own synthetic humans."""
    return _success([
        row for row in rows
        if row["robot"] == robot and row["robot_seed"] in seeds and row["human"] == "human"
        and row["human_seed"] == row["robot_seed"]
    ])  # fmt: skip


def unseen_success(rows: Sequence[Mapping[str, Any]], robot: str) -> Success | None:
    """Success with the synthetic humans of other robot seeds; None with one seed."""
    return _success([
        row for row in rows
        if row["robot"] == robot and row["human"] == "human"
        and row["human_seed"] != row["robot_seed"]
    ])  # fmt: skip


def _success(rows: Sequence[Mapping[str, Any]]) -> Success | None:
    return success_of(Played(row["robot_seed"], row["success"], row["episodes"]) for row in rows)
