"""One body, two minds: MuJoCo's robots with their joints shared out (MaMuJoCo, Gymnasium-Robotics).

pip install gymnasium-robotics
rigid train co-optimize --task pettingzoo:bodies:ant --human-agent agent_0 --out runs/ant
"""

from gymnasium_robotics import mamujoco_v1
from pettingzoo import ParallelEnv


def ant() -> ParallelEnv:
    """Each moves two legs; an episode ends early when the ant falls over."""
    return mamujoco_v1.parallel_env("Ant", "2x4")


def half_cheetah() -> ParallelEnv:
    """One moves the back leg, the other the front leg; an episode lasts 1,000 steps."""
    return mamujoco_v1.parallel_env("HalfCheetah", "2x3")
