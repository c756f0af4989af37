"""Environments as strangers write them, with known answers; factories take no arguments."""

from __future__ import annotations

import gymnasium
import numpy as np
from gymnasium import spaces
from pettingzoo import AECEnv, ParallelEnv
from pettingzoo.utils import parallel_to_aec

from rigid.tasks.bridges import HumanPort

REAL = spaces.Box(-2.0, 6.0, (1,), np.float32)


class Line(ParallelEnv):
    """Points on a line, begun at random. Each sees its own place and the time, and moves by its
    action; its reward is 10 times its number among the agents, plus what was asked for.

    An episode ends by itself after `ends_at` steps, or, where `last_place` is given, as soon as the
    first agent is beyond it.
    """

    def __init__(self, agents=("human", "robot"), action=REAL, **options):
        self.possible_agents, self.agents = list(agents), []
        self._action, self._options = action, options
        self.metadata = {"name": "line", "render_fps": 20, "is_parallelizable": True}
        self.render_mode = None
        if "max_cycles" in options:
            self.max_cycles = options["max_cycles"]

    def observation_space(self, agent):
        del agent
        return spaces.Box(-np.inf, np.inf, (2,), np.float32)

    def action_space(self, agent):
        del agent
        return self._action

    def reset(self, seed=None, options=None):
        del options
        rng = np.random.default_rng(seed)
        self.agents, self.time = list(self.possible_agents), 0
        self.places = {agent: float(rng.normal()) for agent in self.agents}
        self.done = []
        return self._seen(), {agent: {} for agent in self.agents}

    def step(self, actions):
        options = self._options
        self.time += 1
        self.done.append(actions)
        if self.time == options.get("fails_at"):
            raise ZeroDivisionError("a stranger's mistake")
        for agent in self.agents:
            self.places[agent] += float(np.sum(actions[agent]))
        seen = self._seen()
        rewards = {a: 10 * i + options.get("reward", 1.0) for i, a in enumerate(self.agents)}
        over = self.time == options.get("ends_at")
        over |= self.places[self.agents[0]] > options.get("last_place", np.inf)
        infos = {agent: {"is_success": self.time >= 2} for agent in self.agents}
        ends = dict.fromkeys(self.agents, over)
        if over and options.get("one_leaves"):
            self.agents, ends = self.agents[:-1], dict.fromkeys(self.agents, False)
            seen.pop(self.possible_agents[-1])
        elif over:
            self.agents = []
        return seen, rewards, ends, dict.fromkeys(ends, False), infos

    def _seen(self):
        return {a: np.array([self.places[a], self.time], np.float32) for a in self.agents}


def two():
    return Line(max_cycles=4)


def three():
    return Line(("ann", "bob", "cleo"), max_cycles=4)


def numbered():
    return Line((0, 1), max_cycles=4)


def short():
    """Every episode ends after 3 steps."""
    return Line(ends_at=3, max_cycles=8)


def deserted():
    """After 3 steps the robot is gone."""
    return Line(ends_at=3, max_cycles=8, one_leaves=True)


def beyond():
    """An episode ends when the human is beyond 1."""
    return Line(last_place=1.0, max_cycles=8, reward=-1.0)


def endless():
    return Line()


def choosing():
    return Line(action=spaces.Discrete(3, start=-1), max_cycles=4)


def unbounded():
    return Line(action=spaces.Box(-np.inf, np.inf, (1,)), max_cycles=4)


def failing():
    return Line(fails_at=2, max_cycles=4)


def taking_turns():
    return parallel_to_aec(two())


class Turns(AECEnv):
    metadata = {"name": "turns", "is_parallelizable": False}  # noqa: RUF012 - as PettingZoo has it


def turns():
    return Turns()


def broken():
    raise RuntimeError("no licence found")


def with_argument(size):
    return Line(size)


def nothing():
    return 5


class Nameless(Line):
    """Says who its agents are only after a reset, as PettingZoo allows."""

    def __init__(self, **options):
        super().__init__(**options)
        self._names = self.possible_agents
        del self.possible_agents

    def reset(self, seed=None, options=None):
        self.possible_agents = self._names
        found = super().reset(seed, options)
        del self.possible_agents
        return found


def nameless():
    return Nameless(max_cycles=4)


class Unsteady(Line):
    """Goes wrong in one of several ways after a step."""

    def step(self, actions):
        found = super().step(actions)
        if self._options["wrong"] == "size":
            found[0]["human"] = np.zeros(3, np.float32)
        elif self._options["wrong"] == "success":
            found[4]["robot"]["is_success"] = 2
        return found


def growing():
    return Unsteady(max_cycles=4, wrong="size")


def very_successful():
    return Unsteady(max_cycles=4, wrong="success")


class Room(gymnasium.Env):
    """A robot and a person on a line. The person moves by its action, the robot towards it."""

    observation_space = spaces.Dict({
        "robot": spaces.Box(-np.inf, np.inf, (1,)), "door": spaces.Discrete(2),
    })  # fmt: skip
    action_space = spaces.Box(-1.0, 1.0, (1,))
    human_action_space = spaces.Box(-2.0, 2.0, (1,))

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed, options=options)
        self.person, self.robot = float(self.np_random.normal()), 0.0
        return self._seen(), {}

    def step(self, action):
        self.robot += float(action[0])
        distance = abs(self.robot - self.person)
        return self._seen(), -distance, distance < 0.1, False, {"success": distance < 1}

    def _seen(self):
        return {"robot": np.array([self.robot], np.float32), "door": int(self.robot > 0)}

    def apply_human_action(self, action):
        self.person += float(action[0])

    def human_features(self):
        return {"place": self.person}


def room():
    return gymnasium.wrappers.TimeLimit(Room(), 5)


def ported():
    """The same, through a port, and the person sees itself alone."""
    env = Room()
    return HumanPort(
        env=env,
        actions=1,
        apply=env.apply_human_action,
        features=lambda: [env.person],
        observe=lambda: [env.person],
    )


class Body(Room):
    """Names what naturalness sees in another order after each step, and may grow."""

    grows = False

    def step(self, action):
        self.steps = getattr(self, "steps", 0) + 1
        return super().step(action)

    def reset(self, *, seed=None, options=None):
        self.steps = 0
        return super().reset(seed=seed, options=options)

    def human_features(self):
        found = {"place": self.person, "steps": float(self.steps)}
        if self.steps and self.grows:
            found["tail"] = 0.0
        return dict(reversed(found.items())) if self.steps % 2 else found


def reordering():
    return gymnasium.wrappers.TimeLimit(Body(), 5)


def growing_body():
    env = Body()
    env.grows = True
    return gymnasium.wrappers.TimeLimit(env, 5)


def longer_row():
    """Its features, a row without names, become more."""
    env = Body()
    return HumanPort(
        env=gymnasium.wrappers.TimeLimit(env, 5),
        actions=1,
        apply=env.apply_human_action,
        features=lambda: [0.0] * (1 + env.steps),
        observe=lambda: [env.person],
    )


def unpeopled():
    return gymnasium.make("CartPole-v1")
