"""Particles that talk and move (Multi-Particle Environments, as in mpe2); 25 steps each.

pip install mpe2
rigid train co-optimize --task pettingzoo:particles:spread --human-agent agent_0 --out runs/mpe
"""

from mpe2 import simple_reference_v3, simple_speaker_listener_v4, simple_spread_v3
from pettingzoo import ParallelEnv


def speaker_listener() -> ParallelEnv:
    """The human sees the goal and says one of three words; the robot hears it and moves."""
    return simple_speaker_listener_v4.parallel_env()


def reference() -> ParallelEnv:
    """Each knows the other's goal, speaks and moves, all in reals."""
    return simple_reference_v3.parallel_env(continuous_actions=True)


def spread() -> ParallelEnv:
    """Three cover three places without bumping into each other; two of them may be the robot."""
    return simple_spread_v3.parallel_env()
