"""Played episodes of random numbers in the right shapes, and studies that are small."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from rigid.study.plan import PlayStage, PractiseStage, Role, StudyPlan, WatchStage
from rigid.study.records import Answer, EpisodeArrays, PlayedRecord
from rigid.study.store import Store
from rigid.tasks.protocol import Task

STATE = 60
"""Numbers in a snapshot of a toy; real ones have a few hundred."""


def toy_arrays(task: Task, *, seed: int = 0) -> EpisodeArrays:
    """An episode of random numbers in which nothing ran away.

    Features move within [-0.5, 0.5], actions within [-1, 1], a control step takes 0.1 s and begins
    up to 2 ms late.
    """
    rng = np.random.default_rng(seed)
    steps, human, robot = task.horizon, task.human, task.robot
    at = 0.1 * np.arange(steps) + rng.uniform(0, 0.002, steps)
    return EpisodeArrays(
        states=rng.standard_normal((steps + 1, STATE)),
        features=rng.uniform(-0.5, 0.5, (steps, len(task.feature_names))),
        human_observations=rng.standard_normal((steps, human.observation_size)),
        robot_observations=rng.standard_normal((steps, robot.observation_size)),
        human_actions=rng.uniform(-1, 1, (steps, human.action_size)),
        robot_actions=rng.uniform(-1, 1, (steps, robot.action_size)),
        rewards=rng.standard_normal(steps),
        unwanted_force=np.zeros(steps),
        faulted=np.zeros(steps, dtype=bool),
        targets=rng.standard_normal((steps, 3)),
        target_age=np.where(np.arange(steps) > 0, rng.uniform(0, 0.04, steps), np.inf),
        step_times=at,
    )


def toy_record(task: Task, code: str = "P01", number: int = 0, **changes) -> PlayedRecord:
    """A finished episode; its numbers follow from code, kind, robot and number, or from `seed`.

    Args:
        task: Gives the sizes, such as `rigid.make_task("itch-scratching")` or
            `tests.toys.ToyReach()`.
        code: The participant's.
        number: Of the episode.
        changes: Other fields than the default ones.
    """
    key = f"{code}/{changes.get('kind', 'play')}/{changes.get('robot', 'a')}/{number}"
    seed = changes.get("seed", zlib.crc32(key.encode()))
    arrays = changes.pop("arrays", None) or toy_arrays(task, seed=seed)
    fields = {
        "participant": code, "number": number, "kind": "play", "role": "novice", "robot": "a",
        "device": "mouse", "seed": seed, "attempts": 1,
        "episode_return": float(arrays.rewards.sum()), "success": 0.0,
        "outcome": task.outcome_names[-1], "peak_force": 1.5, "impulse": 0.25,
        "started": "2026-01-05T10:00:00+00:00",
        "about_device": {"screen": [1920, 1080], "frame_rate": 60.0}, "arrays": arrays,
    }  # fmt: skip
    return PlayedRecord(**fields | changes)


def toy_answer(code: str = "P01", trial: str = "t00", response: float = 1.0, **changes) -> Answer:
    """An answer to a questionnaire on correspondence, in stage 1."""
    fields = {
        "participant": code, "stage": 1, "trial": trial, "question": "correspondence",
        "pair": int(trial[1:]), "shown_left": "first", "position": int(trial[1:]), "of": "both",
        "response": response, "rt": 2.5, "passed": None, "answered": "2026-01-05T10:00:00+00:00",
    }  # fmt: skip
    return Answer(**fields | changes)


def toy_plan(robots: Mapping[str, str] | None = None, **changes) -> StudyPlan:
    """Novices who watch 1 episode, practise 2 and play 3 with each robot."""
    stages = (WatchStage(episodes=1), PractiseStage(episodes=2), PlayStage(episodes=3))
    fields = {
        "title": "Toy",
        "robots": robots or {"a": "builtin:vanilla"},
        "roles": {"novice": Role(participants=2, stages=stages)},
    }
    return StudyPlan(**fields | changes)


def consented(store: Store, role: str = "novice", *, sharing: bool = True, **invited) -> str:
    """A new participant who has consented to version 1 and skipped demographics; their code."""
    code = store.invite(role, **invited).code
    store.consent(code, "1", sharing)
    store.demographics(code, {})
    return code


def played_study(data: Path, task: Task, plan: StudyPlan, people: int = 2, **record) -> Store:
    """A study in which people did all that is asked of novices of `toy_plan`."""
    # Here, since it imports JAX, which processes that only store do without.
    from rigid.study.registration import register_study

    store = Store.open(data, plan)
    register_study(store, plan, task=task)
    for _ in range(people):
        code = consented(store)
        store.watched(code, 0, "c0")
        for stage, kind, count in ((1, "practise", 2), (2, "play", 3)):
            for number in range(count):
                store.add_episode(toy_record(task, code, number, kind=kind, **record), stage)
        store.finish(code)
    return store
