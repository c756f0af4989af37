"""What a measurement needs before its first adversary: the players, canonical data, the ruler."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import jax
import numpy as np
from jaxtyping import Float

from rigid.compute.canonical import (
    FEWEST,
    Divided,
    chosen_features,
    divide_recorded,
    divide_synthetic,
)
from rigid.compute.endings import ended, measure
from rigid.compute.playing import play_in_turns, play_with
from rigid.compute.return_range import ReturnRange, range_in_force
from rigid.compute.run.identity import identity_of
from rigid.compute.search.scoring import Ruler, naturalness_of, seen_by_referee
from rigid.compute.subject import Subject, canonical_path, load_players, stranger
from rigid.data.episodes import CanonicalEpisodes, load_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.learning.adversary_settings import ALONE, SHARED, AdversarySettings
from rigid.learning.group_play import Opponent, phase_rng
from rigid.learning.rollout import Trajectories, policy_actor
from rigid.naturalness.choice import DEFAULT_MEASURE, check_measure
from rigid.naturalness.features import Features, choose_features, seen_through
from rigid.naturalness.panel import train_panel
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy
from rigid.presets import Preset
from rigid.tasks.protocol import Task, adversarialness
from rigid.tasks.views.ranged import with_range

_BLOCK = 100  # Episodes played side by side in every recording.


@dataclass(frozen=True)
class Prepared:
    """The frozen part of a measurement."""

    task: Task
    """The subject's, with the features and the range that the user chose."""
    opponent: Opponent
    ruler: Ruler
    return_range: ReturnRange
    """The ruler's, and where it comes from."""
    canonical: dict[str, Any]
    """The `canonical` block of `frontier.json`."""
    env_steps: int
    steps_per_second: float
    """Environment steps per second of canonical play, for the estimate of time."""
    identity: dict[str, Any]


def prepare(
    subject: Subject,
    preset: Preset,
    settings: AdversarySettings,
    say: Callable[[str], None] = lambda _: None,
) -> Prepared:
    """Loads the players and plays the canonical episodes of search and referee.

    Args:
        subject: Who is measured.
        preset: Budget.
        settings: How adversaries are trained.
        say: Told that play begins, once nothing that the user named is refused any more.

    Raises:
        UserError: Something the user named does not exist, is damaged or does not fit.
    """
    if subject.canonical_draw < 0:
        raise UserError(f"canonical_draw is {subject.canonical_draw}, but must be 0 or more")
    features = choose_features(subject.features, subject.task)
    range_ = range_in_force(subject.task, subject.return_range)
    task = with_range(subject.task, range_.ends) if range_.source != "task" else subject.task
    robot, human = load_players(subject)
    warning = stranger(subject.robot, subject.human, human, subject.task)
    if warning is not None:
        say(warning)
    referee = RefereeSettings()
    canonical, played = _canonical(subject, robot, human, preset, features, referee, say)
    ruler = Ruler(canonical.folds, range_.ends, referee)
    begun = time.perf_counter()
    human_play = _human_play(task, robot, human, subject.canonical_draw)
    reward_std = deviation(human_play.reward)
    spent = time.perf_counter() - begun
    search = canonical.search
    opponent = Opponent(robot, human.parameters, search.features, search.seeds, reward_std)
    return Prepared(
        seen_through(task, features),
        opponent,
        ruler,
        range_,
        _canonical_block(range_, canonical, human_play),
        env_steps=(played + _BLOCK) * task.horizon,
        steps_per_second=_BLOCK * task.horizon / spent,
        identity={
            **identity_of(task, robot, human, canonical.whole, preset, settings),
            "features": features.label,
            "canonical_draw": subject.canonical_draw,
        },
    )


def passive_reference(task: Task, prepared: Prepared, preset: Preset) -> dict[str, Any]:
    """Where a human who does nothing stands: a reference for the eye, never an attack."""
    human = PassivePolicy(task.human.observation_size, task.human.action_size)
    rng = phase_rng(0, "referee")
    parts = (preset.referee_episodes, preset.validation_episodes, preset.scoring_episodes)
    starts = rng.integers(2**31, size=sum(parts))
    episodes = play_in_turns(
        task, prepared.opponent.robot, lambda worlds: policy_actor(human, worlds, None), starts
    )
    ends = np.cumsum(parts)
    splits = (slice(0, ends[0]), slice(ends[0], ends[1]), slice(ends[1], None))
    train, validation, test = (seen_by_referee(episodes, part) for part in splits)
    ruler = prepared.ruler
    panel = train_panel(ruler.folds, train, validation, ruler.settings, jax.random.key(0))
    scored = slice(len(starts) - preset.scoring_episodes, None)
    found = measure(ended(episodes), scored, task, ruler.return_range)
    return {**naturalness_of(panel, test), **found}


def _canonical(
    subject: Subject,
    robot: Policy,
    human: GaussianPolicy,
    preset: Preset,
    features: Features,
    settings: RefereeSettings,
    say: Callable[[str], None],
) -> tuple[Divided, int]:
    """Canonical episodes by use, and how many of them had to be played."""
    path = canonical_path(subject)
    beginning = f"preparing {subject.robot} on {subject.task.name} (preset {preset.name})"

    def seen(episodes: CanonicalEpisodes) -> CanonicalEpisodes:
        return replace(episodes, features=chosen_features(features, episodes, path))

    given = None if path is None else load_episodes(path, task=subject.task)
    if path is not None and given is not None and given.source == "recorded":
        if subject.canonical_draw:
            raise UserError(
                f"canonical_draw is {subject.canonical_draw}, but {path} holds recorded people, "
                "who cannot be played again: leave it at 0"
            )
        search, folds = preset.search_canonical, settings.folds
        divided = divide_recorded(seen(given), search=search, folds=folds, where=path)
        say(beginning)
        return divided._replace(whole=given), 0
    seen_given = None if given is None else seen(given)
    say(beginning)
    count, referee = 0, 3 * preset.referee_canonical
    if given is None:
        count = _played(preset.search_canonical)
        given = record(
            subject.task, robot, human, episodes=preset.search_canonical,
            seed=subject.search_seed, batch=_BLOCK,
            provenance={"robot": subject.robot, "human": subject.human},
        )  # fmt: skip
    held_out = record(
        subject.task, robot, human, episodes=referee, seed=subject.ruler_seed, batch=_BLOCK,
        provenance={},
    )  # fmt: skip
    divided = divide_synthetic(seen_given or seen(given), seen(held_out))
    return divided._replace(whole=given), count + _played(referee)


def _played(episodes: int) -> int:
    """Episodes that it takes to record `episodes` of them, faults aside."""
    return -(-episodes // _BLOCK) * _BLOCK


def _human_play(task: Task, robot: Policy, human: GaussianPolicy, draw: int) -> Trajectories:
    """Episodes of the human; the deviation of their reward is σ_R of the search."""
    rng = phase_rng(draw, "canonical")
    starts = rng.integers(2**31, size=_BLOCK)
    return play_with(task, robot, policy_actor(human, _BLOCK, rng), starts)


def deviation(reward: Float[np.ndarray, "*n"]) -> float:
    """Standard deviation of reward, above 0, in whatever unit it comes.

    Where reward never changes, its size is the unit, and 1 where it is always 0: no number of a
    search may depend on the unit that a task counts reward in.

    Example:
        >>> deviation(np.array([0.0, 0.002])), deviation(np.zeros(2))
        (0.001, 1.0)
    """
    size = float(np.abs(reward).max())
    return max(float(reward.std()), 1e-6 * size) or 1.0


def _canonical_block(
    range_: ReturnRange, canonical: Divided, human_play: Trajectories
) -> dict[str, Any]:
    """The canonical point; where too few returns of people are known, that of their human."""
    returns = _known(canonical.referee.returns[canonical.anchor])
    recorded = len(returns) > 0
    if not recorded:
        returns = human_play.returns[human_play.faulted == 0]
    success = _known(canonical.referee.success[canonical.anchor])
    return {
        "success": float(success.mean()) if len(success) else None,
        "return": float(returns.mean()),
        "adversarialness": float(adversarialness(returns, range_.ends).mean()),
        "episodes": len(canonical.search),
        "episodes_referee": len(canonical.referee),
        "source": canonical.search.source,
        "return_source": "episodes" if recorded else "human",
        "return_episodes": len(returns),
    }


def _known(values: Float[np.ndarray, " E"]) -> Float[np.ndarray, " _n"]:
    """Those that are known; none where some are not and fewer than `FEWEST` are."""
    known: Float[np.ndarray, " _n"] = values[np.isfinite(values)]
    return known if len(known) >= min(FEWEST, len(values)) else np.zeros(0)


def settings_for(
    preset: Preset, memory: int = 1, search_measure: str = DEFAULT_MEASURE
) -> AdversarySettings:
    """The adversary's settings under a preset's budget."""
    if memory < 1:
        raise UserError(f"memory is {memory}, but an adversary sees at least 1 observation")
    return AdversarySettings(
        iterations=preset.iterations, episodes=preset.episodes, memory=memory,
        measure=check_measure(search_measure), sharing=preset.sharing,
        ppo=ALONE if preset.sharing is None else SHARED,
    )  # fmt: skip


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
