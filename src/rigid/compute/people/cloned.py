"""A human cloned from recorded episodes, and what shows whether it may stand for the people.

Two questions: does it foresee what held-out people did, and does it move like the recorded ones
when it plays with the robot itself? Small errors add up over an episode (Ross et al., 2011), so the
first is no answer to the second.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

from rigid.compute.canonical import FEWEST, pick
from rigid.compute.endings import ended, measure
from rigid.compute.people.clone_judging import clone_naturalness, held_out_naturalness, play_clone
from rigid.data.episodes import CanonicalEpisodes, data_hash
from rigid.errors import UserError
from rigid.learning.censored import CENSORED
from rigid.learning.cloning import (
    CloningSettings,
    Likelihoods,
    Pairs,
    Parts,
    Progress,
    clone,
    compare,
    divide,
)
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task

NATURAL = 0.8
"""A clone that the referee finds less natural stands for nobody: the search would start where it
should not even end. Ours: the start of the range of `auc_natural`."""
UNSURE = 0.05
"""Standard error of naturalness from which on it is told to be uncertain. Ours."""


@dataclass(frozen=True)
class Cloned:
    """A human and what is known of it."""

    policy: GaussianPolicy
    parts: Parts
    likelihoods: Likelihoods
    recorded: dict[str, float | None]
    """Mean return and success of the recorded episodes; None where unknown."""
    played: dict[str, Any]
    """The same of the clone with the robot, with its naturalness at all levels, and in `held_out`
    its naturalness against people it was not cloned from; None where those are too few."""
    sha256: str
    """Of the episodes."""
    clipped: float
    """Share of recorded actions at the ends of their range."""

    @property
    def problems(self) -> list[str]:
        """Why the clone should not stand for these people; empty where it may."""
        found = []
        if self.likelihoods.clone <= self.likelihoods.mean_action:
            found.append(
                "it foresees what held-out people did no better than their mean action: record "
                "more episodes, or observations that tell what they did"
            )
        if self.played["naturalness"] < NATURAL:
            found.append(
                f"with the robot it is only {self.played['naturalness']:.2f} natural, less than "
                f"{NATURAL}: a search would begin at behaviour that nobody showed"
            )
        return found

    @property
    def remarks(self) -> list[str]:
        """What to know about it."""
        found = []
        if self.played["held_out"] is None:
            found.append(
                f"fewer than {FEWEST} held-out episodes: its naturalness is mostly against the "
                "very people that it was cloned from"
            )
        if self.likelihoods.last_action > self.likelihoods.clone:
            found.append(
                "doing the last action again foresees people better: what they do depends on more "
                "than they see at a moment, which a clone without memory misses"
            )
        error = self.played["naturalness_se"]
        if error is None or error > UNSURE:
            found.append(
                "its naturalness is uncertain, and referees with few episodes err towards natural: "
                "record more"
            )
        return found

    def as_json(self) -> dict[str, Any]:
        """For `clone.json`."""
        return {
            "log_likelihood": self.likelihoods._asdict(),
            "held_out_by": self.parts.by,
            "episodes": {name: len(getattr(self.parts, name))
                         for name in ("train", "validation", "test")},
            "std": np.exp(np.asarray(self.policy.parameters.log_std, np.float64)).tolist(),
            "clipped_actions": self.clipped, "recorded": self.recorded, "played": self.played,
            "problems": self.problems, "remarks": self.remarks, "canonical": self.sha256,
        }  # fmt: skip


def clone_human(
    task: Task,
    robot: Policy,
    episodes: CanonicalEpisodes,
    settings: CloningSettings,
    *,
    seed: int,
    rollouts: int = 200,
    where: Path,
    report: Callable[[Progress], None] = lambda _: None,
    say: Callable[[str], None] = lambda _: None,
) -> Cloned:
    """Clones the human of recorded episodes and plays it with the robot.

    Args:
        task: Theirs.
        robot: Whom the human met; acts by its mean.
        episodes: With observations and actions.
        settings: The recipe.
        seed: Everything random comes from it.
        rollouts: Episodes that the clone plays, at least 20.
        where: The file, for messages.
        report: Told of the training.
        say: Told what comes next.

    Raises:
        UserError: Actions or observations are missing, or there are fewer than 12 episodes.
    """
    check_clonable(episodes, where)
    notes = [note.participant for note in episodes.about.episodes]
    parts = divide(len(episodes), notes, settings, seed)
    train, validation, test = (_pairs(episodes, which) for which in parts[:3])
    parameters = clone(train, validation, settings, seed=seed, report=report)
    steps = episodes.features.shape[1]
    policy = GaussianPolicy(parameters)
    say(f"playing {rollouts} episodes with the robot")
    played = play_clone(task, robot, policy, rollouts, seed)
    say("training referees that tell the clone from the recorded people")
    found = {
        **clone_naturalness(task, episodes, played, seed),
        "held_out": held_out_naturalness(task, pick(episodes, parts.test), played, seed),
        **measure(ended(played.episodes), slice(None), task, task.return_range),
    }
    actions = episodes.actions
    assert actions is not None
    return Cloned(
        policy, parts, compare(parameters, train, test, steps, settings),
        {"return": _mean(episodes.returns), "success": _mean(episodes.success)}, found,
        data_hash(episodes), float((np.abs(actions) >= CENSORED).mean()),
    )  # fmt: skip


def made_by(
    cloned: Cloned, episodes: CanonicalEpisodes, settings: CloningSettings
) -> dict[str, Any]:
    """For the policy's card: consent and licence of the data go with what was made of it."""
    about = episodes.about
    return {
        "settings": asdict(settings), "canonical": cloned.sha256, "source": episodes.source,
        "consent": about.consent, "licence": about.licence,
    }  # fmt: skip


def check_clonable(episodes: CanonicalEpisodes, where: Path) -> None:
    """Refuses episodes that no human can be cloned from.

    Raises:
        UserError: Actions or observations are missing, or there are fewer than 12 episodes.
    """
    lacking = [name for name in ("observations", "actions") if getattr(episodes, name) is None]
    if lacking:
        raise UserError(
            f"{where} holds no {' and no '.join(lacking)} of the human, and what people saw and "
            "did cannot be told from how they moved: record them, or leave the clone and measure "
            "with a synthetic human (--human)"
        )
    if len(episodes) < FEWEST:
        raise UserError(
            f"{where} holds {len(episodes)} episodes, but a clone and its referee need at least "
            f"{FEWEST}: record more"
        )


def _pairs(episodes: CanonicalEpisodes, which: np.ndarray) -> Pairs:
    assert episodes.observations is not None
    assert episodes.actions is not None
    seen, done = episodes.observations[which], episodes.actions[which]
    return Pairs(
        jnp.asarray(seen.reshape(-1, seen.shape[2])), jnp.asarray(done.reshape(-1, done.shape[2]))
    )


def _mean(values: np.ndarray) -> float | None:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else None
