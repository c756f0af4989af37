"""What judges read of fixed humans, by the number of canonical episodes that they have.

The paper's advice for a new domain: 'steadily increase the size of the dataset, and visualize the
Naturalness measure on OOD data'. Two judges have n canonical episodes and nothing else of p:

  * a discriminator, as the search has one, trained on all n against one human's episodes; it reads
    the share of the human's other steps with D < 0 (`naturalness_own`);
  * a referee, trained on half of them, stopped by a quarter and calibrated on the other quarter,
    which is one of the four folds that recorded episodes are cross-fitted in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, PRNGKeyArray

from benchmarks.ablations.humans import CANONICAL, Parts
from benchmarks.ablations.plan import Sizes
from benchmarks.ablations.training import Workplace, judged_by, referee_of
from benchmarks.study import once, say
from rigid.data.recording import record
from rigid.naturalness.lsgan import (
    DiscriminatorSettings,
    Network,
    init_discriminator,
    noise_level,
    score,
    update_discriminator,
)
from rigid.naturalness.panel import split_in_folds
from rigid.naturalness.rates import rate
from rigid.naturalness.referee import HEADLINE_KAPPA, RefereeSettings, log_ratio
from rigid.naturalness.standardise import canonical_scale, standardise
from rigid.naturalness.views import Episodes
from rigid.policies.gaussian import GaussianPolicy

DISCRIMINATOR, REFEREE = "discriminator", "referee"
JUDGES = (DISCRIMINATOR, REFEREE)
_POOL_SEED = 3  # Of the canonical episodes that are drawn from. Ours.

Reading = dict[str, Any]
"""Judge, human, episodes, repeat, naturalness, and the share of fresh canonical steps it passed."""


class Verdict(NamedTuple):
    """What a judge says."""

    naturalness: float
    canonical_passed: float
    """Share of the steps of fresh canonical episodes that it takes for canonical."""


def read_sizes(place: Workplace, seed: int, humans: Mapping[str, Parts] | None) -> list[Reading]:
    """Every reading; those that were kept are read from disk.

    Args:
        place: Where they are kept.
        seed: Of the adversaries among the humans.
        humans: Their episodes; None where nothing is missing.
    """
    sizes = place.plan.sizes
    pool = None if humans is None else canonical_pool(place)
    readings: list[Reading] = []
    for repeat in range(sizes.repeats):
        for episodes in sizes.episodes:
            path = size_part(place, seed, repeat, episodes)
            if not path.exists():
                say(f"{episodes} canonical episodes, set {repeat + 1} of {sizes.repeats}")

            def make(repeat: int = repeat, episodes: int = episodes) -> list[Reading]:
                assert pool is not None
                assert humans is not None
                return _readings(pool[repeat], episodes, humans, place, repeat)

            readings += once(path, make)
    return readings


def size_part(place: Workplace, seed: int, repeat: int, episodes: int) -> Path:
    """Where the readings of one canonical set are."""
    return place.out / "sizes" / f"s{seed}" / f"r{repeat}-n{episodes}.json"


def canonical_pool(place: Workplace) -> Float[np.ndarray, "R E T f"]:
    """Fresh canonical episodes: for each repeat as many as the largest size takes."""
    sizes = place.plan.sizes
    most, robot = sizes.episodes[-1], place.prepared().opponent.robot
    human = GaussianPolicy(place.prepared().opponent.human)
    episodes = record(
        place.task, robot, human, episodes=most * sizes.repeats, seed=_POOL_SEED, provenance={}
    ).features
    return episodes.reshape(sizes.repeats, most, *episodes.shape[1:])


def _readings(
    pool: Float[np.ndarray, "E T f"],
    episodes: int,
    humans: Mapping[str, Parts],
    place: Workplace,
    repeat: int,
) -> list[Reading]:
    """Both judges on every human; a larger set begins with the smaller one."""
    sizes, fresh = place.plan.sizes, humans[CANONICAL].test
    readings = []
    for number, (name, human) in enumerate(humans.items()):
        keys = jax.random.split(jax.random.key(repeat * len(humans) + number))
        settings = place.plan.default.settings.discriminator
        verdicts = {
            DISCRIMINATOR: by_discriminator(pool, episodes, human, fresh, sizes, settings, keys[0]),
            REFEREE: by_referee(pool[:episodes], human, fresh, keys[1]),
        }
        readings += [
            {"judge": judge, "human": name, "episodes": episodes, "repeat": repeat,
             **verdict._asdict()}
            for judge, verdict in verdicts.items()
        ]  # fmt: skip
    return readings


def by_discriminator(
    pool: Float[np.ndarray, "E T f"],
    episodes: int,
    human: Parts,
    fresh: Episodes,
    sizes: Sizes,
    settings: DiscriminatorSettings,
    key: PRNGKeyArray,
) -> Verdict:
    """What a discriminator reads that has the first canonical episodes of `pool`."""
    canonical = pool[:episodes]
    scale = canonical_scale(canonical)
    # Repeated until all sizes have as many rows: drawn from alike, and compiled once.
    rows = np.tile(canonical, (len(pool) // episodes, 1, 1)).reshape(-1, pool.shape[-1])
    other = human.train.features[human.train.sound]
    other = np.resize(other, (human.train.sound.size, pool.shape[-1]))
    network = _train(
        *(jnp.asarray(standardise(scale, each)) for each in (rows, other)), key,
        settings=settings, iterations=sizes.iterations,
    )  # fmt: skip

    def passed(seen: Episodes) -> float:
        scores = np.asarray(score(network, jnp.asarray(standardise(scale, seen.features))))
        return rate(scores < 0, seen.sound).value

    return Verdict(passed(human.test), passed(fresh))


def by_referee(
    canonical: Float[np.ndarray, "E T f"],
    human: Parts,
    fresh: Episodes,
    key: PRNGKeyArray,
) -> Verdict:
    """What a referee reads that has these canonical episodes."""
    settings = RefereeSettings()
    folds = split_in_folds(canonical, settings.folds)[:1]
    panel = referee_of(folds, human, settings, key)
    (referee,) = next(iter(panel.values())).referees
    ratios = log_ratio(referee, fresh.features)
    passed = rate(ratios < np.log(HEADLINE_KAPPA), fresh.sound).value
    return Verdict(judged_by(panel, human).value, passed)


@partial(jax.jit, static_argnames=("settings", "iterations"))
def _train(
    canonical: Float[Array, "n f"],
    other: Float[Array, "m f"],
    key: PRNGKeyArray,
    *,
    settings: DiscriminatorSettings,
    iterations: int,
) -> Network:
    """The search's discriminator and schedule, against a human who does not learn."""
    first, rest = jax.random.split(key)
    start = init_discriminator(first, canonical.shape[1], settings)

    def step(carry: Any, iteration: Array) -> tuple[Any, None]:
        noise = noise_level(iteration.astype(jnp.float32), settings)
        own = jax.random.fold_in(rest, iteration)
        # Such a human was yesterday as today: the newest episodes are the replay as well.
        after, _ = update_discriminator(carry, canonical, other, other, noise, own, settings)
        return after, None

    trained, _ = jax.lax.scan(step, start, jnp.arange(iterations))
    return trained.network


def settled(readings: Mapping[int, float], tolerance: float) -> int:
    """The smallest size from which on every reading stays near that of the largest.

    Example:
        >>> settled({5: 0.30, 10: 0.12, 20: 0.19, 40: 0.11, 80: 0.10}, tolerance=0.05)
        40
    """
    sizes = sorted(readings)
    last = readings[sizes[-1]]
    far = [size for size in sizes if abs(readings[size] - last) > tolerance]
    return next(size for size in sizes if not far or size > far[-1])


def humans_of(readings: Sequence[Reading]) -> list[str]:
    """Who was read, in order."""
    return list(dict.fromkeys(reading["human"] for reading in readings))
