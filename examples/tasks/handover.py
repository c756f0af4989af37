"""A Gymnasium environment with a person inside, and the three members by which RIGID moves them.

rigid train co-optimize --task gymnasium:handover:make --out runs/handover
"""

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.wrappers import TimeLimit


class Handover(gymnasium.Env):
    """The robot brings its hand to the person's, on a table of 2 m by 2 m; 40 steps at most."""

    observation_space = spaces.Box(-np.inf, np.inf, (4,), np.float32)
    action_space = spaces.Box(-0.1, 0.1, (2,), np.float32)
    human_action_space = spaces.Box(-0.1, 0.1, (2,), np.float32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.person, self.robot = self.np_random.uniform(-1, 1, (2, 2))
        self.velocity = np.zeros(2)
        return self._seen(), {}

    def apply_human_action(self, action):
        """Moves the person's hand; RIGID calls it before each step."""
        self.velocity = np.clip(self.person + action, -1, 1) - self.person
        self.person = self.person + self.velocity

    def human_features(self):
        """What tells natural motion from unnatural motion: of the person alone."""
        (x, y), (dx, dy) = self.person, self.velocity
        return {"x": x, "y": y, "speed x": dx, "speed y": dy}

    def step(self, action):
        self.robot = np.clip(self.robot + action, -1, 1)
        distance = float(np.linalg.norm(self.robot - self.person))
        met = distance < 0.1
        return self._seen(), 10.0 * met - distance, met, False, {"is_success": met}

    def _seen(self):
        return np.concatenate([self.robot, self.person]).astype(np.float32)


def make():
    return TimeLimit(Handover(), 40)
