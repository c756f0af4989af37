"""Either player of itch scratching keeps Gymnasium's contract; the other is played by a policy."""

from dataclasses import dataclass, field

import gymnasium
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.policies.passive import PassivePolicy
from rigid.tasks.views.gymnasium import ITCH_SCRATCHING, SinglePlayerEnv, register
from tests.toys import ToyReach

register()
PLAYERS = ("robot", "human")


@dataclass
class Recorder:
    """Turns one joint ever faster, and keeps what it was asked."""

    observation_size: int = 34
    action_size: int = 10
    seen: list = field(default_factory=list)
    noise: list = field(default_factory=list)

    def initial_state(self, batch):
        return np.zeros(batch)

    def act(self, observation, state, rng):
        self.seen.append(observation)
        self.noise.append(rng)
        action = np.zeros((len(observation), self.action_size))
        action[:, 6] = state
        return action, state + 0.1


def make(**options):
    return gymnasium.make(ITCH_SCRATCHING, **options)


def test_registering_twice_is_harmless():
    register()
    assert ITCH_SCRATCHING == "rigid/ItchScratching-v0"
    assert ITCH_SCRATCHING in gymnasium.registry


def test_the_partner_acts_on_its_own_observation_and_carries_its_state(task):
    partner = Recorder()
    env = SinglePlayerEnv(task, "robot", partner)
    for _ in range(2):  # Its state begins anew with each episode.
        partner.seen.clear()
        env.reset(seed=2)
        elbows = [env._world._world._batch.bind("qpos")[0, 6]]
        for _ in range(4):
            env.step(np.zeros(7))
            elbows.append(env._world._world._batch.bind("qpos")[0, 6])
        moved = np.diff(elbows)
        assert abs(moved[0]) < 1e-9
        assert (np.diff(moved) > 0).all()
        assert [seen.shape for seen in partner.seen] == [(1, 34)] * 4
    assert partner.noise == [None] * 8


def test_a_partner_with_noise_draws_from_the_seed_of_the_episode(task):
    partner = Recorder()
    env = SinglePlayerEnv(task, "robot", partner, partner_noise=True)
    env.reset(seed=2)
    env.step(np.zeros(7))
    assert partner.noise == [env.np_random]


def test_without_a_partner_the_other_player_holds_still(task):
    env = SinglePlayerEnv(task, "robot")
    env.reset(seed=0)
    before = env._world._world._batch.bind("qpos")[0, :10].copy()
    env.step(np.zeros(7))
    np.testing.assert_array_equal(env._world._world._batch.bind("qpos")[0, :10], before)


def test_a_partner_can_be_named(task):
    env = SinglePlayerEnv(task, "robot", "builtin:passive")
    assert isinstance(env._partner, PassivePolicy)


def test_an_episode_is_truncated_at_its_fixed_length():
    env = make(player="human", horizon=3)
    env.reset(seed=0)
    ends = [env.step(np.zeros(10, np.float32))[2:4] for _ in range(3)]
    assert ends == [(False, False), (False, False), (False, True)]


def test_info_tells_success_and_reward_terms():
    env = make(player="human")
    env.reset(seed=0)
    _, reward, *_, info = env.step(np.zeros(10, np.float32))
    terms = [value for name, value in info.items() if name.startswith("reward_")]
    assert sum(terms) == pytest.approx(reward)
    assert info["is_success"] is False


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"player": "dog"}, r"player is 'dog', but must be one of \('robot', 'human'\)"),
        ({"partner": "builtin:nobody"}, "human 'builtin:nobody' is unknown for task"),
        ({"bodi": "male"}, "unknown parameter 'bodi', did you mean 'body'"),
        (
            {"player": "human", "partner": Recorder()},
            "robot 'Recorder' maps 34 observations to 10 actions, but the robot of",
        ),
    ],
)
def test_bad_options_are_answered_with_the_cure(options, message):
    with pytest.raises(UserError, match=message):
        make(**options)


def test_a_task_that_says_no_bounds_has_open_boxes():
    env = SinglePlayerEnv(ToyReach(), "robot")
    assert env.observation_space.shape == (ToyReach().robot.observation_size,)
    assert np.isinf(env.observation_space.high).all()
    env.reset(seed=0)
    assert np.isfinite(env.step(env.action_space.sample())[0]).all()
