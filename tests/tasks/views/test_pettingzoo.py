"""Itch scratching keeps PettingZoo's contract, and shows what the world shows."""

import numpy as np
import pytest
from pettingzoo.test import api_test, seed_test

from rigid.tasks import itch_scratching_v0
from rigid.tasks.views.pettingzoo import TwoPlayerEnv
from tests.tasks.scripted import random_actions


@pytest.fixture
def env(task):
    return TwoPlayerEnv(task)


def play(env, seed, steps, rng_seed=0):
    """Rows of what `step` returns, under random actions."""
    rng, rows = np.random.default_rng(rng_seed), [env.reset(seed=seed)]
    for _ in range(steps):
        robot, person = random_actions(rng, 1)
        rows.append(env.step({"robot": robot[0], "human": person[0]}))
    return rows


# It would have players numbered and alike; ours are called after their roles.
@pytest.mark.filterwarnings("ignore:We recommend agents to be named:UserWarning")
@pytest.mark.filterwarnings("ignore:(Agents have|Observations are) different:UserWarning")
def test_the_turn_based_contract_is_kept(capsys):
    api_test(itch_scratching_v0.env(), num_cycles=250)
    seed_test(itch_scratching_v0.env, num_cycles=30)
    assert "Passed" in capsys.readouterr().out


def test_it_is_called_after_its_task_and_version(env):
    assert str(env) == "itch_scratching_v0"
    assert env.metadata["render_modes"] == []


def test_spaces_are_finite_boxes_of_single_precision(env, task):
    for agent in env.possible_agents:
        seen, done = env.observation_space(agent), env.action_space(agent)
        assert np.isfinite(seen.low).all()
        assert np.isfinite(seen.high).all()
        assert seen.dtype == done.dtype == np.float32
        assert seen.shape == (getattr(task, agent).observation_size,)
        assert (done.low == -1).all()
        assert (done.high == 1).all()


def test_an_episode_plays_like_the_same_seed_in_a_world(env, task):
    world, rng = task.make_world(1, threads=1), np.random.default_rng(0)
    rows = play(env, seed=5, steps=20)
    world.reset(np.array([5]))
    for seen, rewards, *_, infos in rows[1:]:
        step = world.step(*random_actions(rng, 1))
        box = env.observation_space("robot")
        expected = np.clip(step.robot_observation[0], box.low, box.high)
        np.testing.assert_array_equal(seen["robot"], expected)
        assert rewards == {"robot": step.reward[0], "human": step.reward[0]}
        assert infos["human"]["distance"] == step.info["distance"][0]


def test_observations_are_clipped_to_their_space(env):
    env.reset(seed=0)
    world, box = env._world, env.observation_space("robot")
    far = np.full((1, *box.shape), 1e6, dtype=np.float32)
    world._step = world._step._replace(robot_observation=far)
    np.testing.assert_array_equal(world.observation("robot"), box.high)
    world._step = world._step._replace(robot_observation=-far)
    np.testing.assert_array_equal(world.observation("robot"), box.low)


def test_episodes_are_truncated_at_their_fixed_length_and_never_terminated(env):
    *earlier, last = play(env, seed=0, steps=100)[1:]
    for _, _, terminated, truncated, _ in earlier:
        assert not any({**terminated, **truncated}.values())
    assert last[2] == {"robot": False, "human": False}
    assert last[3] == {"robot": True, "human": True}
    assert env.agents == []
    with pytest.raises(ValueError, match="no episode is under way: call reset"):
        env.step({"robot": np.zeros(7), "human": np.zeros(10)})


def test_info_tells_reward_terms_forces_and_success_in_plain_numbers(env):
    _, rewards, _, _, infos = play(env, seed=1, steps=3)[-1]
    assert infos["robot"] == infos["human"]
    info = infos["robot"]
    terms = [value for name, value in info.items() if name.startswith("reward_")]
    assert sum(terms) == pytest.approx(rewards["robot"])
    assert info["is_success"] is False
    assert info["counted"] is False
    assert info["faulted"] is False
    assert info["outcome"] == "unhelped"
    assert {"force_itch", "force_unwanted", "force_on_person", "peak_force", "impulse",
            "counted_contacts", "distance"} <= info.keys()  # fmt: skip
    assert all(type(value) in {bool, int, float, str} for value in info.values())


def test_the_info_of_one_agent_is_not_the_others(env):
    _, infos = env.reset(seed=0)
    infos["robot"]["mine"] = 1
    assert "mine" not in infos["human"]


def test_success_shows_in_the_info(env):
    env.reset(seed=0)
    env._world._world.counted[:] = 25
    *_, infos = env.step({"robot": np.zeros(7), "human": np.zeros(10)})
    assert infos["human"]["is_success"] is True
    assert infos["human"]["outcome"] == "helped"


def test_resets_without_a_seed_go_on_from_the_last_seed(task):
    def starts(env):
        first = env.reset(seed=3)[0]
        return [first["robot"], *(env.reset()[0]["robot"] for _ in range(3))]

    one, other = (starts(TwoPlayerEnv(task)) for _ in range(2))
    np.testing.assert_array_equal(one, other)
    assert len(np.unique(one, axis=0)) == 4


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ({"robot": np.zeros(7)}, r"actions has none for 'human', only for \['robot'\]"),
        (
            {"robot": np.zeros(6), "human": np.zeros(10)},
            r"actions\['robot'\] has shape \(6,\), but must have \(7,\)",
        ),
        (
            {"robot": np.zeros(7), "human": np.full(10, np.nan)},
            r"actions\['human'\] is not finite: \[nan",
        ),
    ],
)
def test_actions_that_do_not_fit_are_refused(env, actions, message):
    env.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        env.step(actions)
