"""Scoring: every adversary on fresh episodes, judged by its own referee."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from rigid.compute.endings import Ended, ended, measure
from rigid.learning.adversary import Adversary, Opponent, group_actor, phase_rng
from rigid.learning.rollout import Actor, Trajectories, play, policy_actor
from rigid.naturalness import lsgan
from rigid.naturalness.referee import (
    HEADLINE_KAPPA,
    KAPPAS,
    Referee,
    RefereeSettings,
    Rows,
    log_ratio,
    overlap,
    train_referee,
)
from rigid.naturalness.standardise import Scale, canonical_scale, standardise
from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.networks import MLP
from rigid.policies.protocol import Policy
from rigid.presets import Preset
from rigid.tasks.protocol import Task

_UNKNOWN_LEVELS = ("window16_k1", "window16_k4", "window16_k16")
"""Other axes that `frontier.json` has room for: this version's referee judges single steps."""


@dataclass(frozen=True)
class Ruler:
    """What naturalness and adversarialness are measured with; the same for every adversary."""

    train: Float[np.ndarray, "E T f"]
    """Canonical features that referees learn from; no search ever sees these three parts."""
    validation: Float[np.ndarray, "E T f"]
    test: Float[np.ndarray, "E T f"]
    return_range: tuple[float, float]
    settings: RefereeSettings

    @property
    def scale(self) -> Scale:
        """Frozen moments of the canonical training part."""
        return canonical_scale(self.train)


class Court(NamedTuple):
    """Where adversaries are judged."""

    task: Task
    opponent: Opponent
    ruler: Ruler
    preset: Preset


class Judged(NamedTuple):
    """A referee and what it said on the episodes that select λ."""

    network: MLP
    naturalness: float
    """Headline naturalness on validation episodes; steers the search, never the frontier."""


def judge(court: Court, policies: Sequence[GaussianParameters], entropy: int) -> list[Judged]:
    """Trains one referee for each adversary on episodes of its own."""
    preset = court.preset
    rng = phase_rng(entropy, "referee")
    count = preset.referee_episodes + preset.validation_episodes
    starts = rng.integers(2**31, size=count)
    episodes = play_with(
        court.task, court.opponent.robot, group_actor(policies, rng), starts, humans=len(policies)
    )
    judged = []
    for index in range(len(policies)):
        features, sound = _own(episodes, index, count)
        train, validation = (
            _rows(features[:, part], sound[:, part])
            for part in (slice(preset.referee_episodes), slice(preset.referee_episodes, None))
        )
        key = jax.random.fold_in(jax.random.key(entropy), index)
        referee = train_on(court.ruler, Rows(train, validation), key)
        judged.append(Judged(referee.network, _levels(court.ruler, referee, validation)[0]))
    return judged


def train_on(ruler: Ruler, adversary: Rows, key: jax.Array) -> Referee:
    """A referee between the ruler's canonical rows and one human's."""
    canonical = Rows(_flat(ruler.train), _flat(ruler.validation))
    return train_referee(canonical, adversary, ruler.scale, ruler.settings, key)


def score(
    court: Court, group: Sequence[Adversary], judged: Sequence[Judged], entropy: int
) -> list[tuple[dict[str, Any], dict[str, np.ndarray]]]:
    """Plays fresh episodes of every adversary and measures them.

    Returns:
        For each adversary its entry of `frontier.json` (without id and training facts), and the
        arrays that are stored of its episodes.
    """
    rng = phase_rng(entropy, "score")
    count = court.preset.scoring_episodes
    starts = rng.integers(2**31, size=count)
    policies = [adversary.learner.policy for adversary in group]
    snapshots: list[np.ndarray] = []
    episodes = play_with(
        court.task, court.opponent.robot, group_actor(policies, rng), starts,
        humans=len(group), snapshots=snapshots,
    )  # fmt: skip
    endings = ended(episodes)
    shown = [_shown(endings, _block(index, count)) for index in range(len(group))]
    companions, films = _canonical_companions(court, starts[np.concatenate(shown)], entropy)
    results = []
    for index, adversary in enumerate(group):
        features, sound = _own(episodes, index, count)
        referee = Referee(judged[index].network, court.ruler.scale)
        rows = _rows(features, sound)
        own = lsgan.score(
            adversary.discriminator.network,
            jnp.asarray(standardise(canonical_scale(court.opponent.canonical), rows)),
        )
        mine, picks = _block(index, count), shown[index]
        point = {
            **naturalness_of(court.ruler, referee, rows),
            "naturalness_own": float(np.mean(np.asarray(own) < 0)),
            "naturalness_selection": judged[index].naturalness,
            **measure(endings, mine, court.task, court.ruler.return_range),
        }
        companion = slice(2 * index, 2 * index + 2)
        arrays = {
            "seeds": starts,
            **{name: column[mine] for name, column in endings._asdict().items()},
            "shown": picks,
            "snapshots": np.stack(snapshots)[:, mine][:, picks].swapaxes(0, 1),
            "canonical_returns": companions.returns[companion],
            "canonical_outcome": companions.outcome[companion],
            "canonical_snapshots": films[companion],
        }
        results.append((point, arrays))
    return results


def naturalness_of(
    ruler: Ruler, referee: Referee, rows: Float[np.ndarray, "n f"]
) -> dict[str, Any]:
    """The naturalness fields of a point, from held-out rows of one human."""
    headline, by_kappa = _levels(ruler, referee, rows)
    return {
        "naturalness": headline,
        "naturalness_all": {
            **{f"step_k{kappa:g}": value for kappa, value in by_kappa.items()},
            **dict.fromkeys(_UNKNOWN_LEVELS),
        },
    }


def _levels(
    ruler: Ruler, referee: Referee, rows: Float[np.ndarray, "n f"]
) -> tuple[float, Mapping[float, float]]:
    """Headline naturalness, and that of every κ, on the ruler's held-out canonical part."""
    adversary, canonical = log_ratio(referee, rows), log_ratio(referee, _flat(ruler.test))
    levels = {kappa: overlap(adversary, canonical, kappa) for kappa in KAPPAS}
    return levels[HEADLINE_KAPPA], levels


def play_with(
    task: Task,
    robot: Policy,
    human: Actor,
    starts: Int[np.ndarray, " n"],
    *,
    humans: int = 1,
    snapshots: list[np.ndarray] | None = None,
) -> Trajectories:
    """Plays episodes from `starts` with each of several humans, in one set of worlds.

    Args:
        task: The task.
        robot: Acts by its mean.
        human: Acts for all humans at once; their worlds follow one another in equal blocks.
        starts: Episode seeds, the same for every human.
        humans: How many there are.
        snapshots: Is given one entry a step, for replays.
    """
    seeds = np.tile(starts, humans)
    world = task.make_world(len(seeds))

    def keep(*_: object) -> None:
        if snapshots is not None:
            snapshots.append(world.snapshot())

    actor = policy_actor(robot, len(seeds), None)
    return play(task, world, seeds, actor, human, watch=keep)


def _canonical_companions(
    court: Court, seeds: Int[np.ndarray, " n"], entropy: int
) -> tuple[Ended, Float[np.ndarray, "n T1 state"]]:
    """The synthetic human from the same starts, to be shown beside the adversaries."""
    snapshots: list[np.ndarray] = []
    human = GaussianPolicy(court.opponent.human)
    actor = policy_actor(human, len(seeds), phase_rng(entropy, "canonical"))
    played = play_with(court.task, court.opponent.robot, actor, seeds, snapshots=snapshots)
    return ended(played), np.stack(snapshots).swapaxes(0, 1)


def _shown(endings: Ended, mine: slice) -> Int[np.ndarray, "2"]:
    """The episodes that the report shows: the worst one and the median one that did not run away.

    Where all of them did, there is nothing better to show.
    """
    faulted = endings.faulted[mine]
    order = np.lexsort((endings.returns[mine], faulted))  # Those that did come last.
    sound = int((faulted == 0).sum()) or len(order)
    return order[[0, sound // 2]]


def _block(index: int, count: int) -> slice:
    return slice(index * count, (index + 1) * count)


def _own(episodes: Trajectories, index: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """One adversary's features (T, N, f) and which of its steps came before any fault (T, N)."""
    mine = _block(index, count)
    return episodes.features[:, mine], episodes.weight[:, mine] > 0


def _rows(features: np.ndarray, sound: np.ndarray) -> np.ndarray:
    rows: np.ndarray = features[sound]
    return rows


def _flat(features: Float[np.ndarray, "E T f"]) -> Float[np.ndarray, "n f"]:
    return features.reshape(-1, features.shape[-1])
