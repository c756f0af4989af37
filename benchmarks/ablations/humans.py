"""The fixed humans that discriminators and referees have to read, and their episodes by use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import jax.numpy as jnp
import mujoco
import numpy as np

from benchmarks.study import say
from rigid.compute.endings import Ended, ended
from rigid.compute.playing import play_with
from rigid.compute.search.scoring import seen_by_referee
from rigid.learning.rollout import Actor, Trajectories, policy_actor
from rigid.naturalness.views import Episodes
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.itch_scratching.task import ItchScratching

CANONICAL = "canonical, held out"
NOISE = 2.5
"""Action noise of the noisy human over that of the synthetic human. Ours."""
_SEED = 4  # Of their episodes: neither the search's nor the ruler's nor the pool's.


class Parts(NamedTuple):
    """Episodes of one human by use."""

    train: Episodes
    validation: Episodes
    test: Episodes
    ended: Ended
    """How those that test ended."""


def parts_of(episodes: Trajectories, counts: Sequence[int], human: int = 0) -> Parts:
    """Divides the episodes of one of several humans, who were played in equal blocks.

    Args:
        episodes: Of all of them.
        counts: Episodes that train, validate and test.
        human: Whose block.
    """
    total = sum(counts)
    first, second = counts[0], counts[0] + counts[1]
    begin = human * total
    own = seen_by_referee(episodes, slice(begin, begin + total))
    tested = slice(begin + second, begin + total)
    return Parts(
        own.part(slice(first)),
        own.part(slice(first, second)),
        own.part(slice(second, None)),
        Ended(*(column[tested] for column in ended(episodes))),
    )


def fixed_humans(
    task: ItchScratching,
    robot: Policy,
    human: GaussianPolicy,
    adversaries: dict[str, Policy],
    counts: Sequence[int],
) -> dict[str, Parts]:
    """Episodes of every human that is read, by name; the canonical one comes last.

    Args:
        task: Itch scratching.
        robot: With whom all of them play.
        human: The synthetic human.
        adversaries: Others, by name.
        counts: Episodes of each that train, validate and test.
    """
    total = sum(counts)
    log_std = human.parameters.log_std + jnp.log(NOISE)
    noisy = GaussianPolicy(human.parameters._replace(log_std=log_std))
    passive = PassivePolicy(task.human.observation_size, task.human.action_size)

    def acting(policy: Policy) -> Callable[[np.random.Generator, list[np.ndarray]], Actor]:
        return lambda rng, _: policy_actor(policy, total, rng)

    everybody = {
        **{name: acting(policy) for name, policy in adversaries.items()},
        "passive": acting(passive),
        "for the other itch": lambda rng, seen: for_the_other_itch(task, human, rng, seen),
        f"{NOISE:g} times the noise": acting(noisy),
        CANONICAL: acting(human),
    }
    found = {}
    for number, (name, make) in enumerate(everybody.items()):
        say(f"playing {total} episodes: {name}")
        rng = np.random.default_rng([_SEED, number])
        starts = rng.integers(2**31, size=total)
        seen: list[np.ndarray] = []
        played = play_with(task, robot, make(rng, seen), starts, snapshots=seen)
        found[name] = parts_of(played, counts)
    return found


def for_the_other_itch(
    task: ItchScratching,
    human: GaussianPolicy,
    rng: np.random.Generator,
    snapshots: Sequence[np.ndarray],
) -> Actor:
    """Acts as the synthetic human would if the other of the two itches itched.

    Args:
        task: Itch scratching.
        human: Who is mistaken.
        rng: Consumed.
        snapshots: Of the worlds acted in, the newest last.
    """
    data = mujoco.MjData(task.model)
    names = task.human.observation_names
    tip, gap, itch = (
        [names.index(f"{thing}_{axis}") for axis in "xyz"]
        for thing in ("tip", "tip_to_itch", "itch")
    )

    def other(row: np.ndarray) -> np.ndarray:
        data.qpos[:] = row[: task.model.nq]
        mujoco.mj_kinematics(task.model, data)
        limb = LIMBS[1 - int(row[-2])]  # Before the last column: which of the two itches.
        return np.asarray(data.site(f"itch_{limb}").xpos - task.chest)

    def act(observation: np.ndarray) -> np.ndarray:
        mistaken = observation.copy()
        mistaken[:, itch] = [other(row) for row in snapshots[-1]]
        mistaken[:, gap] = mistaken[:, tip] - mistaken[:, itch]
        return human.act(mistaken, (), rng)[0]

    return act
