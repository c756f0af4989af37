"""A fresh robot trained against one frozen human: what could have been done about this motion?

Ours: the paper counts a human out of reach like a human whom another robot would have helped. The
response first imitates the robot that failed (on its own visits, Ross et al., 2011), then learns by
PPO alone. What it reaches bounds what a robot can do from below, at this budget.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import jax
import jax.numpy as jnp
import numpy as np

from rigid.learning.cooptimisation import Progress
from rigid.learning.learner import Learner, Rollout, with_noise
from rigid.learning.ppo import PPOSettings, init_learner, ppo_update
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.policies.discrete import taken
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import AgentSpec, Task


@dataclass(frozen=True, kw_only=True)
class ResponseSettings:
    """Budget of one best response; all values ours."""

    iterations: int = 60
    imitation: int = 20
    """Iterations at the start that imitate the robot that failed."""
    episodes: int = 48
    """Episodes of one iteration."""
    hidden: tuple[int, ...] = (100, 100)
    std: tuple[float, float] = (0.2, 0.05)
    """Action noise at the start and at the end."""
    reward_scale: float = 0.1
    """Keeps the critic's targets near 1."""
    ppo: PPOSettings = field(default_factory=lambda: PPOSettings(minibatch=960))


_update = jax.jit(ppo_update, static_argnames="settings")


def best_response(
    task: Task,
    human: Policy,
    robot: Policy,
    settings: ResponseSettings,
    *,
    seed: int,
    report: Callable[[Progress], None] = lambda _: None,
) -> GaussianPolicy:
    """Trains a robot for `human`.

    Args:
        task: What they play, as the response sees it (`SeeingEverything` shows it more).
        human: Frozen; it samples its actions.
        robot: The robot that failed; it sees the first part of what the response sees.
        settings: Budget.
        seed: Everything random comes from it.
        report: Called after every iteration.
    """
    learner = init_learner(
        jax.random.key(seed),
        settings.ppo,
        observation_size=task.robot.observation_size,
        critic_observation_size=task.robot.observation_size + task.human.observation_size,
        action_size=task.robot.action_size,
        hidden=settings.hidden,
        std=settings.std[0],
    )
    world, key = task.make_world(settings.episodes), jax.random.key(seed)
    imitating = replace(settings.ppo, cloning_coefficient=1.0, policy_coefficient=0.0)
    for iteration in range(settings.iterations):
        learner = with_noise(learner, _noise(settings, iteration))
        rng = np.random.default_rng([seed, iteration])
        lesson = _Lesson(robot, task.robot, learner, settings.episodes, rng)
        starts = rng.integers(2**31, size=settings.episodes)
        person = policy_actor(human, settings.episodes, rng)
        episodes = play(task, world, starts, lesson.act, person)
        ppo = imitating if iteration < settings.imitation else settings.ppo
        rollout = _rollout(episodes, np.stack(lesson.taught), settings.reward_scale)
        learner, _ = _update(learner, rollout, jax.random.fold_in(key, iteration), settings=ppo)
        success = float(np.mean(episodes.summary.success))
        report(Progress(iteration, float(episodes.returns.mean()), success, lesson.noise))
    return GaussianPolicy(learner.policy)


class _Lesson:
    """One set of episodes: the learner acts, and the robot that failed says what it would do."""

    def __init__(
        self,
        robot: Policy,
        spec: AgentSpec,
        learner: Learner,
        batch: int,
        rng: np.random.Generator,
    ) -> None:
        self._robot, self._spec, self._rng = robot, spec, rng
        self._student = GaussianPolicy(learner.policy)
        self._state = robot.initial_state(batch)
        self._visible = robot.observation_size
        self.noise = float(np.exp(np.asarray(learner.policy.log_std)[0]))
        self.taught: list[np.ndarray] = []

    def act(self, seen: np.ndarray) -> np.ndarray:
        advice, self._state = self._robot.act(seen[:, : self._visible], self._state, None)
        self.taught.append(taken(advice, self._spec))
        action, _ = self._student.sample(seen, (), self._rng)
        return action


def _noise(settings: ResponseSettings, iteration: int) -> float:
    """Action noise of an iteration, geometric from the first to the last value."""
    first, last = settings.std
    return float(first * (last / first) ** (iteration / max(settings.iterations - 1, 1)))


def _rollout(episodes: Trajectories, taught: np.ndarray, reward_scale: float) -> Rollout:
    seen = episodes.robot_observation
    both = np.concatenate([seen, episodes.human_observation], axis=-1)
    return Rollout(
        observation=jnp.asarray(seen),
        critic_observation=jnp.asarray(both),
        action=jnp.asarray(episodes.robot_action),
        reward=jnp.asarray(episodes.reward * episodes.weight * reward_scale),
        weight=jnp.asarray(episodes.weight),
        expert_action=jnp.asarray(taught, jnp.float32),
    )
