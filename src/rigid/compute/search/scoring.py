"""Scoring: every adversary on fresh episodes, judged by its own referee."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Float, Int

from rigid.compute.endings import Ended, ended, measure
from rigid.compute.playing import play_in_turns, play_with
from rigid.learning.adversary import Adversary, own_scores
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.group_play import Opponent, group_actor, phase_rng
from rigid.learning.rollout import Trajectories, policy_actor
from rigid.naturalness.panel import AXIS, Fold, Panel, naturalness, train_panels
from rigid.naturalness.rates import rate
from rigid.naturalness.referee import RefereeSettings
from rigid.naturalness.views import Episodes
from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.presets import Preset
from rigid.tasks.protocol import Task

KEPT_EPISODES = 20
"""Scored episodes whose features are stored, for other discriminators to judge: 2,000 steps of itch
scratching. Ours."""


@dataclass(frozen=True)
class Ruler:
    """What naturalness and adversarialness are measured with; the same for every adversary."""

    folds: tuple[Fold, ...]
    """Canonical episodes that no search ever sees: one fold, or K of recorded people."""
    return_range: tuple[float, float]
    settings: RefereeSettings


class Court(NamedTuple):
    """Where adversaries are judged."""

    task: Task
    opponent: Opponent
    ruler: Ruler
    preset: Preset
    settings: AdversarySettings
    """What the adversaries were trained with; says how their own discriminators score."""
    threads: int = 0
    """Threads that step worlds; 0: every core."""


class Judged(NamedTuple):
    """An adversary's referees and what they said on the episodes that select λ."""

    panel: Panel
    naturalness: float
    """Headline naturalness on validation episodes; steers the search, never the frontier."""


Scored = tuple[dict[str, Any], dict[str, np.ndarray]]
"""Of an adversary its entry of `frontier.json` (without id and training facts), and the arrays that
are stored of its episodes."""


def judge(
    court: Court,
    policies: Sequence[GaussianParameters],
    entropy: int,
    *,
    each: Callable[[], None] = lambda: None,
) -> list[Judged]:
    """Trains the referees of each adversary on episodes of its own; `each` is told of every one."""
    preset = court.preset
    rng = phase_rng(entropy, "referee")
    count = preset.referee_episodes + preset.validation_episodes
    starts = rng.integers(2**31, size=count)
    episodes = play_in_turns(
        court.task, court.opponent.robot, lambda _: group_actor(policies, rng), starts,
        humans=len(policies), threads=court.threads,
    )  # fmt: skip
    parts = slice(preset.referee_episodes), slice(preset.referee_episodes, None)
    seen = []
    for index in range(len(policies)):
        own = seen_by_referee(episodes, _block(index, count))
        seen.append((own.part(parts[0]), own.part(parts[1])))
    ruler = court.ruler
    panels = train_panels(
        ruler.folds, seen, ruler.settings, jax.random.key(entropy), each=each
    )  # fmt: skip
    return [
        Judged(panel, naturalness_of(panel, validation)["naturalness"])
        for panel, (_, validation) in zip(panels, seen, strict=True)
    ]


def score(
    court: Court, group: Sequence[Adversary], judged: Sequence[Judged], entropy: int
) -> list[Scored]:
    """Plays fresh episodes of every adversary and measures them."""
    rng = phase_rng(entropy, "score")
    count = court.preset.scoring_episodes
    starts = rng.integers(2**31, size=count)
    policies = [adversary.learner.policy for adversary in group]
    snapshots: list[np.ndarray] = []
    episodes = play_in_turns(
        court.task, court.opponent.robot, lambda _: group_actor(policies, rng), starts,
        humans=len(group), snapshots=snapshots, threads=court.threads,
    )  # fmt: skip
    endings = ended(episodes)
    shown = [_shown(endings, _block(index, count)) for index in range(len(group))]
    companions, films = _canonical_companions(court, starts[np.concatenate(shown)], entropy)
    results = []
    for index, adversary in enumerate(group):
        scored = seen_by_referee(episodes, _block(index, count))
        own = own_scores(adversary, scored.features, court.opponent, court.settings)
        mine, picks = _block(index, count), shown[index]
        point = {
            **naturalness_of(judged[index].panel, scored),
            "naturalness_own": None if own is None else rate(own < 0, scored.sound).value,
            "naturalness_selection": judged[index].naturalness,
            **measure(endings, mine, court.task, court.ruler.return_range),
        }
        companion = slice(2 * index, 2 * index + 2)
        kept = scored.part(slice(KEPT_EPISODES))
        arrays = {
            "seeds": starts,
            **{name: column[mine] for name, column in endings._asdict().items()},
            "shown": picks,
            "snapshots": np.stack(snapshots)[:, mine][:, picks].swapaxes(0, 1),
            "canonical_returns": companions.returns[companion],
            "canonical_outcome": companions.outcome[companion],
            "canonical_snapshots": films[companion],
            "features": kept.features,
            "sound": kept.sound,
        }
        results.append((point, arrays))
    return results


def naturalness_of(panel: Panel, episodes: Episodes) -> dict[str, Any]:
    """The naturalness fields of a point, from held-out episodes of one human."""
    levels = naturalness(panel, episodes)
    headline = levels[AXIS]
    return {
        # Of a human who ran away at once nothing is known; its faults keep it off the frontier.
        "naturalness": 0.0 if headline is None else headline.value,
        "naturalness_se": None if headline is None else headline.se,
        "naturalness_all": {
            name: None if found is None else found.value for name, found in levels.items()
        },
    }


def seen_by_referee(episodes: Trajectories, mine: slice = slice(None)) -> Episodes:
    """Some of the episodes that were played, as referees take them."""
    features, weight = episodes.features[:, mine], episodes.weight[:, mine]
    return Episodes(features.swapaxes(0, 1), weight.swapaxes(0, 1) > 0)


def _canonical_companions(
    court: Court, seeds: Int[np.ndarray, " n"], entropy: int
) -> tuple[Ended, Float[np.ndarray, "n T1 state"]]:
    """The synthetic human from the same starts, to be shown beside the adversaries."""
    snapshots: list[np.ndarray] = []
    human = GaussianPolicy(court.opponent.human)
    actor = policy_actor(human, len(seeds), phase_rng(entropy, "canonical"))
    played = play_with(
        court.task, court.opponent.robot, actor, seeds, snapshots=snapshots, threads=court.threads
    )
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
