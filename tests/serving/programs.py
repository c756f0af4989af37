"""Programs that serve, and programs that do not: each a file that a user might have written."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
import textwrap
from importlib import resources
from pathlib import Path

SERVE_FILE = Path(str(resources.files("rigid.serving") / "rigid_serve.py"))


def write_program(folder: Path, text: str, name: str = "program.py") -> str:
    """Writes it beside a copy of rigid_serve.py; returns the command that runs it."""
    shutil.copy(SERVE_FILE, folder / "rigid_serve.py")
    path = folder / name
    path.write_text(textwrap.dedent(text), encoding="utf-8")
    return shlex.join([sys.executable, str(path)])


def children() -> set[int]:
    """Processes that this one started and that are still there, zombies too."""
    mine = str(os.getpid())
    found = set()
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                stat = (entry / "stat").read_text()
            except OSError:  # It has just ended.
                continue
            if stat.rpartition(")")[2].split()[1] == mine:
                found.add(int(entry.name))
    return found


DOUBLER = """
    import numpy as np
    import rigid_serve

    print("this goes to whoever looks at standard error")

    def act(observation):
        print("so does this")
        return observation[:, :1] / 2

    rigid_serve.serve_policy(act, observation_size=2, action_size=1)
"""
"""A robot for `tests.toys.ToyReach`: moves by half of where it is."""

REACH = """
    import numpy as np
    import rigid_serve

    SPEED = 0.2

    class Reach:
        def reset(self, seed):
            self.goal = np.random.default_rng(seed).choice([-1.0, 1.0])
            self.robot = self.hand = 0.0
            return self.look()

        def step(self, robot_action, human_action):
            print("a step")
            self.robot += SPEED * robot_action[0]
            self.hand += SPEED * human_action[0]
            distance = abs(self.robot - self.goal)
            info = {"success": distance < 0.1, "distance": distance}
            info["features"] = [self.hand, self.goal]
            return (*self.look(), -distance, False, info)

        def look(self):
            return [self.robot, self.hand], [self.robot, self.hand, self.goal]

    rigid_serve.serve_task(
        Reach, horizon=10, robot=(2, 1), human=(3, 1), feature_names=("hand", "goal"),
        human_observation_names=("robot", "hand", "goal"), return_range=(-20, 0),
    )
"""
"""`tests.toys.ToyReach`, one environment at a time."""
