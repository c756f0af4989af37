"""Every task keeps the contracts of Gymnasium and PettingZoo."""

import gymnasium
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

from rigid.errors import UserError
from rigid.tasks.views.gymnasium import register
from rigid.tasks.views.pettingzoo import TwoPlayerEnv
from tests.tasks.playing import at_rest

register()
PLAYERS = ("robot", "human")


@pytest.mark.parametrize("player", PLAYERS)
def test_the_single_player_contract_is_kept(case, player):
    check_env(gymnasium.make(case.gymnasium_id, player=player, horizon=5).unwrapped)


def test_it_is_called_after_its_task_and_version(case):
    words = "".join(word.capitalize() for word in case.name.split("-"))
    assert case.gymnasium_id == f"rigid/{words}-v0"
    assert str(case.pettingzoo.parallel_env()) == f"{case.folder}_v0"


@pytest.mark.parametrize("player", PLAYERS)
def test_the_spaces_are_those_of_the_player(case, task, player):
    env = gymnasium.make(case.gymnasium_id, player=player, body="female")
    agent = getattr(task, player)
    assert env.observation_space.shape == (agent.observation_size,)
    assert env.action_space.shape == (agent.action_size,)


def test_the_parallel_contract_is_kept(case, capsys):
    parallel_api_test(case.pettingzoo.parallel_env(horizon=10), num_cycles=25)
    assert "Passed" in capsys.readouterr().out


def test_equal_seeds_play_equal_episodes(task):
    parallel_seed_test(lambda: TwoPlayerEnv(task), num_cycles=20)


def test_the_factory_takes_parameters(case, task):
    env = case.pettingzoo.parallel_env(horizon=2)
    env.reset(seed=0)
    still = dict(zip(PLAYERS, (action[0] for action in at_rest(task, 1)), strict=True))
    *_, truncated, infos = [env.step(still) for _ in range(2)][-1]
    assert truncated == {"robot": True, "human": True}
    assert infos["robot"]["outcome"] == "unhelped"
    with pytest.raises(UserError, match="unknown parameter 'bodi', did you mean 'body'"):
        case.pettingzoo.env(bodi="female")
