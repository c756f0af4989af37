"""A task of one's own: the human holds something out along a line, the robot goes to meet it.

`pip install -e .` and `rigid train co-optimize --task hand-over --out pair` is all there is to it.
All arrays have the world as their first axis: one NumPy line serves every world at once.
"""

import numpy as np

from rigid.tasks.protocol import AgentSpec, Step, Summary

SPEED = 0.1  # Metres that a full action moves a hand in a step.
NEAR = 0.1  # Hands as near as this at the end have met [m].


class HandOver:
    """Two hands on a line, begun at random; the reward is minus their distance, and the effort.

    Only the human knows how far it likes to reach: its want, which is the last thing that it sees.
    """

    name, horizon = "hand-over", 20
    robot = AgentSpec(2, 1, ("robot hand", "human hand"))
    human = AgentSpec(3, 1, ("robot hand", "human hand", "want"))
    feature_names = ("human hand", "human speed", "want")  # Of the human alone.
    outcome_names = ("met", "missed")
    return_range = (-30.0, -4.0)  # Returns that mean adversarialness 1 and 0.

    def make_world(self, batch, *, threads=0):
        return HandOverWorld(batch)

    def features(self, step):
        return step.features

    def scene(self):
        return None  # Nothing to draw.

    def replay(self, snapshots):
        return {}

    def describe(self):
        return {"name": self.name, "version": 0, "parameters": {}}


class HandOverWorld:
    def __init__(self, batch):
        self.batch = batch

    def reset(self, seeds):
        starts = [np.random.default_rng(seed).uniform(0, 1, 3) for seed in seeds]
        robot, human, want = np.array(starts).T
        self.robot, self.human, self.want = -robot, human, (want - 0.5) / 2
        return self._look(np.zeros(self.batch), speed=np.zeros(self.batch))

    def step(self, robot_action, human_action):
        speed = SPEED * np.clip(human_action[:, 0], -1, 1)
        self.robot = self.robot + SPEED * np.clip(robot_action[:, 0], -1, 1)
        self.human = self.human + speed
        effort = np.abs(self.human - self.want)  # It likes to hold its hand where it wants to.
        return self._look(-np.abs(self.robot - self.human) - effort, speed)

    def _look(self, reward, speed):
        return Step(
            robot_observation=np.column_stack([self.robot, self.human]),
            human_observation=np.column_stack([self.robot, self.human, self.want]),
            reward=reward,
            features=np.column_stack([self.human, speed, self.want]),
            faulted=np.zeros(self.batch, dtype=bool),
            info={},
        )

    def summary(self):
        met = np.abs(self.robot - self.human) < NEAR
        unknown = np.full(self.batch, np.nan)  # No forces here.
        return Summary(met.astype(float), (~met).astype(int), unknown, unknown, {})

    def snapshot(self):
        return np.zeros((self.batch, 0))
