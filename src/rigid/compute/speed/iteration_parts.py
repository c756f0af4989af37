"""One training iteration of a group of adversaries, whole and in parts, for `rigid bench`.

Every part does what it does in training, with the data of the same episodes: of a turn, all parts
go through one motion, so that their times add up to nearly that of the whole.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, PRNGKeyArray
from mujoco.batch import Batch

from rigid.compute.playing import play_with
from rigid.compute.search.group_plan import GroupInputs
from rigid.compute.speed.timing import wait_for
from rigid.frontier.largest_jump import first_lambdas
from rigid.learning.adversary import (
    Adversary,
    pace_at,
    rollout_of,
    start_adversary,
    train_iteration,
)
from rigid.learning.group_play import Experience, canonical_motion, group_actor
from rigid.learning.learner import Learner, Rollout
from rigid.learning.ppo import PPOSettings, ppo_update
from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.measure import Measure, Motion
from rigid.naturalness.standardise import canonical_scale, standardise
from rigid.tasks.itch_scratching.task import ItchScratching


class Iteration:
    """Iterations of the first group of a search without a shared network, such as preset `paper`'s.

    `renew` plays the episodes that the parts then go through; `whole` trains the group on, from
    episodes of its own.
    """

    def __init__(self, inputs: GroupInputs) -> None:
        preset = inputs.preset
        assert isinstance(inputs.task, ItchScratching)
        self.inputs, self._task = inputs, inputs.task
        lambdas = first_lambdas(preset.lambda_min, preset.lambda_max, preset.per_round[0])
        self.group = [
            start_adversary(inputs.opponent, inputs.settings, lambda_, key)
            for lambda_, key in zip(
                lambdas, jax.random.split(jax.random.key(0), len(lambdas)), strict=True
            )
        ]
        self._world = self._task.make_world(len(lambdas) * preset.episodes, threads=inputs.threads)
        starts = np.resize(inputs.opponent.canonical_seeds, preset.episodes)
        self._starts = np.tile(starts, len(lambdas))
        self._canonical = canonical_motion(inputs.opponent)
        self.renew()

    @property
    def env_steps(self) -> int:
        """Environment steps of one iteration."""
        return len(self._starts) * self._task.horizon

    @property
    def adversaries(self) -> int:
        """Size of the group."""
        return len(self.group)

    def renew(self) -> None:
        """Plays one set of episodes with the group as it is now."""
        opponent, snapshots = self.inputs.opponent, list[np.ndarray]()
        self._played = play_with(
            self._task, opponent.robot, self._human(),
            self._starts[: self.inputs.preset.episodes],
            humans=self.adversaries, snapshots=snapshots, threads=self.inputs.threads,
        )  # fmt: skip
        self._motion = np.stack(snapshots)
        seen, scale = self._played, canonical_scale(opponent.canonical)
        rows = (
            seen.human_observation, seen.human_action, seen.reward / opponent.reward_std,
            seen.weight, standardise(scale, seen.features),
        )  # fmt: skip
        self._experience = Experience(*(jnp.asarray(column) for column in rows))

    def whole(self) -> None:
        """One iteration, everything included."""
        inputs = self.inputs
        results = train_iteration(
            self._task, self._world, self.group, inputs.opponent, inputs.settings, seed=0
        )
        wait_for(results)
        self.group = [adversary for adversary, _ in results]

    def physics(self) -> None:
        """The motion with nothing but MuJoCo."""
        step_through(self._task, self._motion, self.inputs.threads)

    def stepping(self) -> None:
        """The motion in the task's worlds with ready actions: physics, observation and reward."""
        robot, human = iter(self._played.robot_action), iter(self._played.human_action)
        play(self._task, self._world, self._starts, lambda _: next(robot), lambda _: next(human))

    def inference(self) -> None:
        """What robot and adversaries do at each of the recorded observations."""
        robot = policy_actor(self.inputs.opponent.robot, len(self._starts), None)
        human = self._human()
        for seen in zip(
            self._played.robot_observation, self._played.human_observation, strict=True
        ):
            robot(seen[0])
            human(seen[1])

    def ppo(self) -> None:
        """The policy updates of all adversaries."""
        settings, learned = self.inputs.settings, []
        for index, adversary in enumerate(self.group):
            seen = self._of(index)
            rollout = rollout_of(seen.observation, seen.action, seen.reward, seen.weight)
            pace = pace_at(adversary.iteration, settings.iterations)
            key = jax.random.key(index)
            learned.append(_learn(adversary.learner, rollout, key, pace, settings=settings.ppo))
        wait_for(learned)

    def discriminator(self) -> None:
        """What the search measures of all adversaries do: penalty, score and update."""
        measure, held = self.inputs.settings.search_measure, []
        for index, adversary in enumerate(self.group):
            key = jax.random.key(index)
            held.append(_hold(adversary, self._of(index), self._canonical, key, measure=measure))
        wait_for(held)

    def _human(self) -> Any:
        policies = [adversary.learner.policy for adversary in self.group]
        return group_actor(policies, np.random.default_rng(0))

    def _of(self, index: int) -> Experience:
        """The episodes of one adversary."""
        episodes = self.inputs.preset.episodes
        mine = slice(index * episodes, (index + 1) * episodes)
        return Experience(*(rows[:, mine] for rows in self._experience))


@partial(jax.jit, static_argnames="settings")
def _learn(
    learner: Learner,
    rollout: Rollout,
    key: PRNGKeyArray,
    pace: Float[Array, ""],
    *,
    settings: PPOSettings,
) -> Learner:
    return ppo_update(learner, rollout, key, settings, pace)[0]


@partial(jax.jit, static_argnames="measure")
def _hold(
    adversary: Adversary,
    seen: Experience,
    canonical: Float[Array, "E T f"],
    key: PRNGKeyArray,
    *,
    measure: Measure,
) -> Any:
    motion = Motion(seen.features, seen.weight, seen.observation, seen.action)
    state, policy = adversary.measure, adversary.learner.policy
    keys = jax.random.split(key, 2)
    return (
        measure.penalty(state, canonical, motion, policy),
        measure.score(state, seen.features),
        measure.update(state, canonical, motion, policy, adversary.iteration, keys),
    )


def step_through(
    task: ItchScratching, motion: Float[np.ndarray, "T1 B state"], threads: int
) -> Float[np.ndarray, "B q"]:
    """The motion of recorded snapshots again, with ready targets: nothing but MuJoCo.

    Returns:
        Joint angles at its end [rad].
    """
    size = task.model.nq
    batch = Batch(task.model, motion.shape[1], threads)
    batch.bind("qpos")[:] = motion[0, :, :size]
    target = batch.bind("ctrl")
    for snapshot in motion[1:]:
        target[:] = snapshot[:, 2 * size : 3 * size]
        batch.step(nstep=task.parameters.substeps)
    return np.array(batch.bind("qpos"))
