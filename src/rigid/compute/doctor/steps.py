"""The steps of `rigid doctor`: what is played for each, and the verdict on it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.compute.calibration import returns_at
from rigid.compute.canonical import FEWEST, chosen_features, trained_on
from rigid.compute.doctor.curve import Pool, divide, learning_curve
from rigid.compute.listening import Listener
from rigid.compute.subject import Subject, canonical_path
from rigid.data.episodes import load_episodes
from rigid.data.recording import record
from rigid.doctor.data import check_data
from rigid.doctor.ends import End, check_ends
from rigid.doctor.reward import Play, check_reward
from rigid.doctor.scan import check_scan
from rigid.doctor.verdict import Verdict
from rigid.errors import UserError
from rigid.frontier.result import Frontier
from rigid.learning.rollout import Actor, policy_actor
from rigid.naturalness.features import Features
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy
from rigid.presets import Preset
from rigid.tasks.conformance import broken_promises
from rigid.tasks.protocol import Task

_TRAINING, _DISTURBED, _HELD_OUT = 100, 60, 60
"""Canonical episodes of the learning curve, where a human can be played again. Ours."""
LAMBDAS = (0.0, 0.1, 0.3, 1.0, 3.0, 10.0, float("inf"))
"""Both ends, and half-decades between them where `standard` finds its curve. Ours."""
_BLOCK = 100
_SEED = 4  # Of recordings: neither those of other commands nor the search's.


def protocol_verdict(task: Task) -> Verdict:
    """What `rigid.tasks.conformance` says."""
    try:
        broken = broken_promises(task)
    except UserError as error:
        broken = (str(error),)
    if broken:
        return Verdict(
            "protocol", "fail", f"The task breaks its promises: {'; '.join(broken)}.",
            "Mend the task first; every number after it would be wrong.",
        )  # fmt: skip
    return Verdict(
        "protocol", "pass", "Shapes, bounds and copies are as they have to be, and equal seeds "
        "start equal episodes.",
    )  # fmt: skip


class Canonical(NamedTuple):
    """The canonical episodes that the user has."""

    episodes: int
    source: str
    features: Float[np.ndarray, "E T f"] | None
    """None where they are recorded when the search begins."""
    trained: int
    """Episodes that a judge is trained on: the search's all, but each referee only a part."""


def given_episodes(subject: Subject, features: Features, preset: Preset) -> Canonical:
    """The user's canonical episodes, or as many as the search will record."""
    path = canonical_path(subject)
    if path is None:
        return Canonical(preset.search_canonical, "synthetic", None, preset.search_canonical)
    episodes = load_episodes(path, task=subject.task)
    count = trained = len(episodes)
    if episodes.source == "recorded":
        search, folds = preset.search_canonical, RefereeSettings().folds
        trained = trained_on(count, search=search, folds=folds)
    seen = chosen_features(features, episodes, path)
    return Canonical(count, episodes.source, seen, trained)


def players_of(human: Policy, episodes: int) -> dict[str, Actor]:
    """Actors of one set of episodes, by what the page calls them."""
    rng = np.random.default_rng(_SEED)
    passive = PassivePolicy(human.observation_size, human.action_size)
    shape = episodes, human.action_size
    return {
        "canonical": policy_actor(human, episodes, np.random.default_rng([_SEED, 1])),
        "passive": policy_actor(passive, episodes, None),
        "random": lambda _: rng.uniform(-1.0, 1.0, shape),
    }


def data_verdict(
    task: Task,
    robot: Policy,
    human: Policy,
    given: Canonical,
    strangers: Float[np.ndarray, "E T f"],
    listener: Listener,
) -> Verdict:
    """The learning curve; on the user's episodes where people cannot be played again."""
    if given.source == "recorded":
        assert given.features is not None
        if given.episodes < FEWEST:
            return check_data(given.episodes, {}, source=given.source)
        pool = divide(given.features)
    else:
        listener.say("playing canonical episodes for the learning curve")
        everything = record(
            task, robot, human, episodes=_TRAINING + _DISTURBED + _HELD_OUT, seed=_SEED,
            batch=_BLOCK, provenance={},
        ).features  # fmt: skip
        pool = Pool(*np.split(everything, [_TRAINING, _TRAINING + _DISTURBED]))
    curve = learning_curve(pool, strangers=strangers, say=listener.say)
    return check_data(given.episodes, curve, source=given.source, trained=given.trained)


def search_verdicts(
    searched: Frontier, play: Play, preset: Preset, success: float | None
) -> list[Verdict]:
    """Verdicts that need adversaries."""
    canonical = play.returns["canonical"]
    by_lambda = {value: "inf" if np.isinf(value) else value for value in LAMBDAS}
    points = {
        value: [point for point in searched.points if point["lambda"] == name]
        for value, name in by_lambda.items()
    }
    ends = [_end(searched, points[value], by_lambda[value]) for value in (LAMBDAS[0], LAMBDAS[-1])]
    whole = float(canonical.mean()) - _mean(points[LAMBDAS[0]], "return")
    harm = {
        value: (float(canonical.mean()) - _mean(found, "return")) / (whole if whole > 0 else 1.0)
        for value, found in points.items()
    }
    naturalness = {
        value: [float(point["naturalness"]) for point in found] for value, found in points.items()
    }
    return [
        check_reward(replace(play, sabotage=ends[0].returns, iterations=preset.iterations)),
        check_ends(End([canonical], success), *ends),
        check_scan(naturalness, harm),
    ]


def _end(searched: Frontier, points: list[dict[str, Any]], name: float | str) -> End:
    successes = [point["success"] for point in points]
    return End(
        returns_at(searched, name),
        None if None in successes else float(np.mean(successes)),
        [float(point["naturalness"]) for point in points],
    )


def _mean(points: list[dict[str, Any]], key: str) -> float:
    """Over seeds; those of which nothing is known (all episodes ran away) aside."""
    known = [point[key] for point in points if point[key] is not None]
    return float(np.mean(known)) if known else float("nan")
