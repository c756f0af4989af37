"""Two cooks in one small kitchen (Overcooked, as in CoGrid): the soup is for both.

pip install cogrid
rigid train co-optimize --task pettingzoo:kitchen:cramped_room --human-agent 0 --out runs/cooks
"""

from pettingzoo import ParallelEnv


def cramped_room() -> ParallelEnv:
    """One pot, room for one to pass; 1,000 steps of onion soup."""
    import cogrid.envs  # noqa: F401 - Importing it is what registers its kitchens.
    from cogrid.envs.registry import make

    return make("Overcooked-CrampedRoom-V0")
