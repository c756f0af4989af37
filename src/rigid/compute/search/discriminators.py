"""What the discriminators of a search tell apart: `discriminators/sSEED.json` of a run directory.

For each human of a search seed: how far its discriminator, and beside it its referee, still takes
held-out canonical motion for canonical as noise rises, what it says of every human of that seed,
and its verdict on some poses (paper, appendix 'Visualizations of the Discriminator').

One file for each seed, since a discriminator meets the humans of all rounds; measured when the
seed's search is over, since nothing that the report reads can play again. It is made of what the
groups stored, and of noise from the seed alone, so that no interruption shows in it. It is a
picture: no number of `frontier.json` comes from it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from rigid.compute.referee.files import load_panel
from rigid.compute.run.checkpoint import load_arrays, load_tree
from rigid.compute.search.discriminator_files import (
    Accuracy,
    Discriminators,
    Judged,
    Poses,
    Scores,
    file_of,
)
from rigid.compute.search.group_plan import GroupInputs
from rigid.compute.search.scoring import KEPT_EPISODES
from rigid.files import json_text, write_atomically
from rigid.learning.group_play import phase_rng
from rigid.naturalness.measure import Measure
from rigid.naturalness.noise import NOISE_LEVELS, movement, under_noise
from rigid.naturalness.rates import rate
from rigid.naturalness.referee import HEADLINE_KAPPA, log_ratio
from rigid.naturalness.standardise import canonical_scale, standardise
from rigid.naturalness.views import Episodes
from rigid.policies.gaussian import with_memory

CANONICAL_EPISODES = 40
"""Held-out episodes under noise: as many as the search saw. Ours."""
POSE_LEVELS = (0.0, 0.316, 1.0, 3.16, 10.0)
"""Noise of the poses that are shown, out of `NOISE_LEVELS`."""
POSES = 8
"""Poses at each of these levels, and of each human. Ours."""

Judge = Callable[[Float[np.ndarray, "N T f"]], Float[np.ndarray, "N T"]]
"""Scores of every step, negative where it takes it for canonical."""


class _Evidence(NamedTuple):
    """What is judged; the same for every judge of the seed."""

    noisy: list[Float[np.ndarray, "L E T f"]]
    """Canonical episodes under noise, by the fold of the referee that they are held out from."""
    motions: dict[str, Episodes | None]
    shown: Int[np.ndarray, "n 2"]
    """Episode and step of the canonical poses."""
    own: dict[str, Int[np.ndarray, "m 2"]]


def write_discriminators(inputs: GroupInputs, seed: int, humans: Sequence[str]) -> None:
    """Examines the discriminators of a seed whose groups are done, unless that was done before.

    Raises:
        UserError: What a group stored is damaged.
    """
    path = file_of(inputs.directory, seed)
    if path.exists():
        return
    path.parent.mkdir(exist_ok=True)
    found = _examine(inputs, seed, humans)
    write_atomically(path, json_text(found.model_dump()).encode())


def _examine(inputs: GroupInputs, seed: int, humans: Sequence[str]) -> Discriminators:
    evidence, kept = _gather(inputs, seed, humans), _kept_shape(inputs)
    judged = {
        human: _judged(inputs, human, _discriminator(inputs, human, kept), evidence)
        for human in (humans if kept is not None else ())
    }
    return Discriminators(
        levels=NOISE_LEVELS,
        canonical_episodes=sum(part.shape[1] for part in evidence.noisy),
        adversary_episodes=max(len(m.features) if m else 0 for m in evidence.motions.values()),
        judged=None if kept is None else judged,
        poses=_poses(inputs.task.feature_names, evidence),
    )


def _gather(inputs: GroupInputs, seed: int, humans: Sequence[str]) -> _Evidence:
    rng = phase_rng(seed, "discriminators")
    folds = inputs.ruler.folds
    each = -(-CANONICAL_EPISODES // len(folds))
    deviation = movement(inputs.opponent.canonical)
    noisy = [under_noise(fold.test[:each], deviation, rng) for fold in folds]
    episodes, steps = sum(part.shape[1] for part in noisy), noisy[0].shape[2]
    shown = _some(np.ones((episodes, steps), dtype=bool), rng)
    motions = {human: _motion(inputs, human) for human in humans}
    own = {
        human: np.zeros((0, 2), int)
        if motion is None
        else _some(motion.sound, phase_rng(seed, "discriminators", number))
        for number, (human, motion) in enumerate(motions.items(), 1)
    }
    return _Evidence(noisy, motions, shown, own)


def _some(sound: np.ndarray, rng: np.random.Generator) -> Int[np.ndarray, "n 2"]:
    """Episode and step of some sound steps."""
    places = np.argwhere(sound)
    return places[np.sort(rng.permutation(len(places))[:POSES])]


def _motion(inputs: GroupInputs, human: str) -> Episodes | None:
    """The stored motion of a human; None where an earlier RIGID stored none."""
    path = inputs.directory / "adversaries" / human / "episodes.npz"
    stored = load_arrays(path, cure=_cure(human))
    if "features" not in stored or not stored["sound"].any():
        return None
    return Episodes(stored["features"][:KEPT_EPISODES], stored["sound"][:KEPT_EPISODES])


def _cure(human: str) -> str:
    group = human.rpartition("-")[0]
    return f"delete groups/{group}.json to train its group again"


def _judged(inputs: GroupInputs, human: str, judge: Judge, evidence: _Evidence) -> Judged:
    """What the discriminator of a human says, and its referee."""
    every = np.concatenate(evidence.noisy, axis=1)
    referees = _referees(inputs, human)
    return Judged(
        discriminator=_accuracy([judge], [every], evidence.motions),
        referee=None if referees is None else _accuracy(referees, evidence.noisy, evidence.motions),
        scores=_scores(judge, every, evidence, human),
    )


def _kept_shape(inputs: GroupInputs) -> Any:
    """What the search measure stores, by shape; None where it has no classifier."""
    opponent, measure = inputs.opponent, inputs.settings.search_measure
    person = with_memory(opponent.human, inputs.settings.memory)
    canonical = jnp.asarray(opponent.canonical)
    kept = jax.eval_shape(lambda: measure.kept(measure.start(jax.random.key(0), canonical, person)))
    score = jax.eval_shape(partial(_score, measure=measure), kept, canonical)
    return None if score is None else kept


def _discriminator(inputs: GroupInputs, human: str, shape: Any) -> Judge:
    """The stored discriminator, as a judge of features in the task's own units."""
    measure, scale = inputs.settings.search_measure, canonical_scale(inputs.opponent.canonical)
    path = inputs.directory / "adversaries" / human / "discriminator.safetensors"
    kept = load_tree(path, shape, cure=_cure(human))

    def scores(features: np.ndarray) -> np.ndarray:
        seen = jnp.asarray(standardise(scale, features).swapaxes(0, 1))
        return np.asarray(_score(kept, seen, measure=measure)).T

    return scores


@partial(jax.jit, static_argnames="measure")
def _score(
    kept: Any, features: Float[Array, "T N f"], *, measure: Measure
) -> Float[Array, "T N"] | None:
    return measure.score_kept(kept, features)


def _referees(inputs: GroupInputs, human: str) -> list[Judge] | None:
    """Its referees of single steps at the κ of the axis, one for each fold; None without any."""
    jury = load_panel(inputs.directory / "referee", human).get("step")
    if jury is None:
        return None

    def judge(index: int) -> Judge:
        referee = jury.referees[index]
        return lambda features: log_ratio(referee, features) - np.log(HEADLINE_KAPPA)

    return [judge(index) for index in range(len(jury.referees))]


def _accuracy(
    judges: Sequence[Judge],
    noisy: Sequence[Float[np.ndarray, "L E T f"]],
    motions: Mapping[str, Episodes | None],
) -> Accuracy:
    """How often judges are right: each on canonical motion of its own, all on every human."""
    canonical = np.concatenate([
        _over_levels(judge, part) < 0 for judge, part in zip(judges, noisy, strict=True)
    ], axis=1)  # fmt: skip

    def told(motion: Episodes | None) -> float | None:
        if motion is None:
            return None
        suspicious = np.mean([judge(motion.features) >= 0 for judge in judges], axis=0)
        return rate(suspicious, motion.sound).value

    return Accuracy(
        canonical=tuple(canonical.mean(axis=(1, 2)).tolist()),
        adversaries={human: told(motion) for human, motion in motions.items()},
    )


def _over_levels(judge: Judge, noisy: Float[np.ndarray, "L E T f"]) -> Float[np.ndarray, "L E T"]:
    """Scores of episodes at every level of noise."""
    return judge(noisy.reshape(-1, *noisy.shape[2:])).reshape(noisy.shape[:3])


def _scores(
    judge: Judge, noisy: Float[np.ndarray, "L E T f"], evidence: _Evidence, human: str
) -> Scores:
    """Verdicts on the poses, each at its place in its episode: a judge may look back."""
    episodes, steps = evidence.shown.T
    levels = [NOISE_LEVELS.index(level) for level in POSE_LEVELS]
    under = _over_levels(judge, noisy[levels][:, episodes])[:, np.arange(len(steps)), steps]
    motion, own = evidence.motions[human], evidence.own[human]
    mine = np.zeros(0) if motion is None else judge(motion.features)[own[:, 0], own[:, 1]]
    return Scores(noisy=_tuples(under), own=tuple(mine.tolist()))


def _poses(names: Sequence[str], evidence: _Evidence) -> Poses:
    episodes, steps = evidence.shown.T
    every = np.concatenate(evidence.noisy, axis=1)
    levels = [NOISE_LEVELS.index(level) for level in POSE_LEVELS]
    own = {
        human: () if motion is None else _drawn(motion.features[tuple(evidence.own[human].T)])
        for human, motion in evidence.motions.items()
    }
    noisy = _drawn(every[levels][:, episodes, steps])
    return Poses(names=tuple(names), levels=POSE_LEVELS, noisy=noisy, own=own)


def _drawn(features: np.ndarray) -> Any:
    """To the digits that a drawing can show."""
    return _tuples(features.astype(np.float64).round(4))


def _tuples(values: np.ndarray) -> Any:
    """Nested tuples of numbers."""
    return tuple(map(_tuples, values)) if values.ndim > 1 else tuple(values.tolist())
