"""Robots of other libraries, which all episodes share."""

import asyncio
import threading

import numpy as np

from rigid.study.service.engine import Engine
from tests.study.service.serving import TASK, Leaner
from tests.toys import untrained_palm


class Touchy(Leaner):
    """A robot that counts how many ask it at a time."""

    def __init__(self):
        self.asking, self.most, self.met = 0, 0, threading.Event()

    def initial_state(self, batch):
        return self.turn(super().initial_state, batch)

    def act(self, observation, state, rng):
        return self.turn(super().act, observation, state, rng)

    def turn(self, answer, *asked):
        self.asking += 1
        self.most = max(self.most, self.asking)
        self.met.wait(0.01)  # Gives another thread time to come in between.
        found = answer(*asked)
        self.asking -= 1
        return found


def test_a_robot_that_is_not_ours_is_asked_by_one_episode_at_a_time():
    robot = Touchy()
    engine = Engine(TASK, {"a": robot}, threads=4)

    async def play(seed):
        episode = await engine.do(engine.episode, "a", seed)
        for _ in range(3):
            await engine.step(episode.advance, episode.hand, age=0.0, at=0.0)

    async def everybody():
        await asyncio.gather(*(play(seed) for seed in range(4)))

    asyncio.run(everybody())
    engine.close()
    assert robot.most == 1


def test_what_one_episode_does_is_nothing_to_a_robot_in_another():
    """A robot with a memory: its state goes with the episode."""
    robot = untrained_palm(TASK.robot)
    shared = Engine(TASK, {"a": Foreign(robot)}, threads=2)
    apart, mixed = shared.episode("a", 1), [shared.episode("a", 1), shared.episode("a", 2)]
    for _ in range(TASK.horizon):
        apart.advance(apart.hand, age=0.0, at=0.0)
        for episode in mixed:
            episode.advance(episode.hand, age=0.0, at=0.0)
    shared.close()
    np.testing.assert_array_equal(
        apart.finish().arrays.robot_actions, mixed[0].finish().arrays.robot_actions
    )


class Foreign:
    """One of our robots, as if it came from elsewhere."""

    def __init__(self, robot):
        self.observation_size, self.action_size = robot.observation_size, robot.action_size
        self.initial_state, self.act = robot.initial_state, robot.act
