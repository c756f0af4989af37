"""Bed bathing keeps the contracts of Gymnasium and PettingZoo."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

from rigid.tasks import bed_bathing_v0
from rigid.tasks.views.gymnasium import BED_BATHING, register
from rigid.tasks.views.pettingzoo import TwoPlayerEnv

register()


@pytest.mark.parametrize("player", ["robot", "human"])
def test_the_single_player_contract_is_kept(player):
    check_env(gymnasium.make(BED_BATHING, player=player, horizon=5).unwrapped)


def test_it_is_called_as_the_original_is():
    assert BED_BATHING == "rigid/BedBathing-v0"
    env = gymnasium.make(BED_BATHING, player="human", body="female", horizon=3)
    seen, _ = env.reset(seed=1)
    assert seen.shape == (28,)
    assert env.action_space.shape == (10,)


def test_the_parallel_contract_is_kept(capsys):
    parallel_api_test(bed_bathing_v0.parallel_env(horizon=10), num_cycles=25)
    assert "Passed" in capsys.readouterr().out


def test_equal_seeds_play_equal_episodes(task):
    parallel_seed_test(lambda: TwoPlayerEnv(task), num_cycles=20)


def test_the_factory_takes_parameters():
    env = bed_bathing_v0.parallel_env(horizon=2)
    env.reset(seed=0)
    assert str(env) == "bed_bathing_v0"
    still = {"robot": np.zeros(7), "human": np.zeros(10)}
    *_, truncated, infos = [env.step(still) for _ in range(2)][-1]
    assert truncated == {"robot": True, "human": True}
    assert infos["robot"]["outcome"] == "unhelped"
