"""One robot, its canonical data and its judge: what every method is given, how all are judged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import jax
import numpy as np

from benchmarks.planted.handover import HandOver
from benchmarks.planted.people import HABITS, NOISE, Person, aim_of, fit_policy, move_towards
from benchmarks.planted.robots import Follower, Path, Watcher
from benchmarks.planted.weaknesses import Weakness, shown, weaknesses
from rigid.data.recording import record
from rigid.learning.group_play import Opponent
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.naturalness.panel import AXIS, LEVELS, Fold, naturalness, train_panel
from rigid.naturalness.referee import RefereeSettings
from rigid.naturalness.views import Episodes
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import adversarialness

CALIBRATION = 20_000
"""Canonical episodes whose quantiles place the thresholds. Ours, like every number here."""
SEARCH_CANONICAL, REFEREE_CANONICAL = 100, 250
"""Canonical episodes of a search and of each of the referee's three parts: as many steps as the
presets take of itch scratching, whose episodes are 2.5 times as long."""
TRAIN, VALIDATION, SCORING = 250, 125, 250
"""Episodes of a human: the referee's to learn and to choose from, and those it is judged on."""


class Judgement(NamedTuple):
    """Where a human stands with a robot."""

    naturalness: float
    """Headline naturalness, by a referee of its own."""
    adversarialness: float
    shown: float
    """Share of episodes that show the weakness that the robot watches for."""
    missed: float
    """Share of episodes without a hand-over."""


@dataclass(frozen=True)
class Arena:
    """What is frozen for one robot."""

    task: HandOver
    weakness: Weakness
    robot: Policy
    opponent: Opponent
    fold: Fold


def stated_human() -> GaussianPolicy:
    """The canonical human as a network, fitted to its rule on states that it visits itself.

    Three rounds of the rule asked on the network's own visits (Ross et al., 2011).
    """
    task, rng = HandOver(), np.random.default_rng(0)
    human: Policy = Person(HABITS["plain"])
    seen = np.zeros((0, task.human.observation_size), np.float32)
    for round_ in range(3):
        episodes = play_with(task, Follower(), human, 400, rng)
        seen = np.concatenate([seen, episodes.human_observation.reshape(-1, seen.shape[1])])
        human = fit_policy(seen, move_towards(seen, aim_of(seen)), std=NOISE, seed=round_)
    assert isinstance(human, GaussianPolicy)
    return human


def planted(human: GaussianPolicy) -> tuple[Weakness, ...]:
    """The ten weaknesses, their thresholds placed by `human`'s own motion."""
    rng = np.random.default_rng(1)
    return weaknesses(paths(play_with(HandOver(), Follower(), human, CALIBRATION, rng)))


def arena_for(human: GaussianPolicy, weakness: Weakness, *, decoy: bool) -> Arena:
    """The robot that has the weakness, or its decoy, with canonical data of its own."""
    task, robot = HandOver(), Watcher(weakness.sees, gives_up=not decoy)
    search, referee = (
        record(task, robot, human, episodes=count, seed=seed, provenance={})
        for seed, count in ((0, SEARCH_CANONICAL), (1, 3 * REFEREE_CANONICAL))
    )
    rewards = play_with(task, robot, human, 100, np.random.default_rng(2)).reward
    opponent = Opponent(
        robot, human.parameters, search.features, search.seeds, max(float(rewards.std()), 1e-6)
    )
    return Arena(task, weakness, robot, opponent, Fold(*np.split(referee.features, 3)))


def play_with(
    task: HandOver, robot: Policy, human: Policy, episodes: int, rng: np.random.Generator
) -> Trajectories:
    """Fresh episodes; the robot acts by its mean, the human samples."""
    starts = rng.integers(2**31, size=episodes)
    actors = policy_actor(robot, episodes, None), policy_actor(human, episodes, rng)
    return play(task, task.make_world(episodes), starts, *actors)


def paths(episodes: Trajectories) -> Path:
    """The hand's path in each episode [m], shape (N, T, 2)."""
    return np.asarray(episodes.robot_observation[..., :3].swapaxes(0, 1), dtype=np.float64)


def judge(arena: Arena, humans: Sequence[Policy], seed: int) -> list[Judgement]:
    """Each human on episodes that no method has seen, judged by a referee of its own."""
    found = []
    for number, human in enumerate(humans):
        rng = np.random.default_rng([3, seed, number])
        count = TRAIN + VALIDATION + SCORING
        episodes = play_with(arena.task, arena.robot, human, count, rng)
        found.append(judge_episodes(arena, episodes, seed))
    return found


def judge_episodes(arena: Arena, episodes: Trajectories, seed: int) -> Judgement:
    """As `judge`, of episodes that are there: the last `SCORING` of at least so many are scored."""
    seen = Episodes(episodes.features.swapaxes(0, 1), np.ones(episodes.weight.T.shape, dtype=bool))
    scored = slice(TRAIN + VALIDATION, None)
    panel = train_panel(
        [arena.fold], seen.part(slice(TRAIN)), seen.part(slice(TRAIN, TRAIN + VALIDATION)),
        RefereeSettings(), jax.random.key(seed), LEVELS[:1],
    )  # fmt: skip
    natural = naturalness(panel, seen.part(scored))[AXIS]
    assert natural is not None
    assert arena.task.return_range is not None
    return Judgement(
        natural.value,
        float(adversarialness(episodes.returns[scored], arena.task.return_range).mean()),
        float(shown(arena.weakness, paths(episodes)[scored]).mean()),
        float(1 - episodes.summary.success[scored].mean()),
    )


def truth(arena: Arena, human: GaussianPolicy) -> Judgement:
    """How natural the weakness is: episodes that show it, judged by the headline referee.

    Canonical episodes are drawn until enough of them show an event; a motion that is not in the
    data is constructed by its stated human, whose episodes all count.
    """
    count, rng = TRAIN + VALIDATION + SCORING, np.random.default_rng(4)
    if arena.weakness.share is None:
        person = Person(HABITS[arena.weakness.habit])
        return judge_episodes(arena, play_with(arena.task, arena.robot, person, count, rng), 0)
    drawn = int(1.3 * count / arena.weakness.share)
    episodes = play_with(arena.task, arena.robot, human, drawn, rng)
    which = np.flatnonzero(shown(arena.weakness, paths(episodes)))[:count]
    return judge_episodes(arena, chosen(episodes, which), 0)


def chosen(episodes: Trajectories, which: np.ndarray) -> Trajectories:
    """Some of the episodes, in the order of `which`."""
    rows = {name: column[:, which] for name, column in episodes._asdict().items()
            if name != "summary"}  # fmt: skip
    summary = episodes.summary
    kept = summary._replace(
        success=summary.success[which], outcome=summary.outcome[which],
        peak_force=summary.peak_force[which], impulse=summary.impulse[which],
    )  # fmt: skip
    return Trajectories(**rows, summary=kept)
