"""Walkers and hunters that have to work together (SISL, PettingZoo).

pip install "pettingzoo[sisl]"
rigid train co-optimize --task pettingzoo:walkers:multiwalker --human-agent walker_0 --out runs/walk
"""

from pettingzoo import ParallelEnv
from pettingzoo.sisl import multiwalker_v9, pursuit_v5


def multiwalker() -> ParallelEnv:
    """Three walkers carry a package; it is over when one of them falls."""
    return multiwalker_v9.parallel_env()


def pursuit() -> ParallelEnv:
    """Eight hunters on a grid, of whom one may be the human."""
    return pursuit_v5.parallel_env()
