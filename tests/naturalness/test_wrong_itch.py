"""The exploit that features must see: moving naturally, but for the other itch."""

import jax
import numpy as np
import pytest

from rigid.compute.search.scoring import naturalness_of, seen_by_referee
from rigid.data.recording import record
from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.panel import Fold, train_panel
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.loading import load_policy
from rigid.tasks.registry import make_task
from tests.tasks.mistaken import mistaken


@pytest.fixture(scope="module")
def players():
    task = make_task("itch-scratching")
    return (
        task,
        load_policy("builtin:vanilla", task=task, agent="robot"),
        load_policy("builtin:synthetic-human", task=task, agent="human"),
    )


def episodes_for_the_other_itch(players, episodes, seed):
    task, robot, human = players
    world, rng = task.make_world(episodes), np.random.default_rng(seed)
    act = mistaken(task, world, human, rng)
    starts = rng.integers(2**31, size=episodes)
    return play(task, world, starts, policy_actor(robot, episodes, None), act)


def test_a_human_who_acts_as_if_the_other_itch_itched_is_not_natural(players):
    task, robot, human = players
    canonical = record(task, robot, human, episodes=90, seed=5, batch=30, provenance={})
    fold = Fold(*np.split(canonical.features, 3))
    found = [episodes_for_the_other_itch(players, n, seed) for seed, n in enumerate((30, 15, 40))]
    train, validation, held_out = (seen_by_referee(played) for played in found)

    panel = train_panel([fold], train, validation, RefereeSettings(), jax.random.key(0))

    assert found[2].summary.success.mean() == 0
    levels = naturalness_of(panel, held_out)["naturalness_all"]
    assert max(levels.values()) <= 0.3
