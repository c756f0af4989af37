"""A played episode is the task's own, with a hand target in the human's place."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.learning.rollout import play, policy_actor
from rigid.study.play.again import states_again
from rigid.study.play.episode import FAULTED, PlayedEpisode, within
from rigid.study.records import EpisodeArrays
from rigid.tasks.by_hand import Reach
from rigid.tasks.itch_scratching.posture import stored_posture
from tests.toys import ToyReach, untrained_palm

SEED = 5


def wave(step):
    """A hand that circles [m]."""
    return 0.1 * np.array([-np.sin(0.4 * step), 0.0, 1 - np.cos(0.4 * step)])


def played(task, robot, seed=SEED):
    """An episode, its frames and its end."""
    episode = PlayedEpisode(task, robot, seed=seed)
    frames = [episode.begin()]
    while not frames[-1].done:
        step = frames[-1].step
        target = frames[0].hand + wave(step)
        frames.append(episode.advance(target, age=0.01 * step, at=0.1 * step))
    return episode, frames, episode.finish()


@pytest.fixture(scope="module")
def whole(task, robot):
    return played(task, robot)


def test_it_begins_as_the_task_does_and_lasts_as_long(task, whole):
    episode, frames, _ = whole
    world = task.make_world(1, threads=1)
    world.reset(np.array([SEED]))
    np.testing.assert_array_equal(episode._states[0], world.snapshot()[0])
    assert [frame.step for frame in frames] == list(range(task.horizon + 1))
    assert [frame.done for frame in frames] == [False] * task.horizon + [True]


def test_it_says_what_the_page_needs_before_it_begins(task, robot):
    episode = PlayedEpisode(task, robot, seed=SEED)
    assert (episode.substeps, episode.period, episode.horizon) == (5, 0.1, task.horizon)
    assert set(episode.goal) == {"body", "pos", "limb"}
    assert set(episode.reach) == {"shoulder", "radius"}
    names = task.scene()["bodies"]
    assert max(episode.bodies) < len(names)


def test_a_frame_has_every_body_in_every_physics_step(whole):
    episode, frames, _ = whole
    assert frames[0].poses.shape == (1, len(episode.bodies), 7)
    assert frames[1].poses.shape == (episode.substeps, len(episode.bodies), 7)


def test_the_hand_of_a_frame_is_where_it_is_now(whole):
    _, frames, end = whole
    episode, *_ = whole
    for frame, state in zip(frames, end.arrays.states, strict=True):
        np.testing.assert_array_equal(frame.hand, episode.handle.place(state))


def test_everything_of_the_episode_is_kept(task, whole):
    _, _, end = whole
    arrays, steps = end.arrays, task.horizon
    assert arrays.states.shape[0] == steps + 1
    assert arrays.features.shape == (steps, len(task.feature_names))
    assert arrays.human_observations.shape == (steps, task.human.observation_size)
    assert arrays.robot_observations.shape == (steps, task.robot.observation_size)
    assert arrays.human_actions.shape == (steps, task.human.action_size)
    assert arrays.robot_actions.shape == (steps, task.robot.action_size)
    assert np.abs(arrays.human_actions).max() <= 1
    assert np.abs(arrays.robot_actions).max() <= 1
    assert not arrays.faulted.any()
    np.testing.assert_allclose(arrays.target_age, 0.01 * np.arange(steps))
    np.testing.assert_allclose(arrays.step_times, 0.1 * np.arange(steps))
    assert end.episode_return == pytest.approx(arrays.rewards.sum())
    assert end.outcome in task.outcome_names
    assert end.success in (0.0, 1.0)


def test_what_is_kept_survives_the_database(whole):
    arrays = whole[2].arrays
    back = EpisodeArrays.from_bytes(arrays.to_bytes())
    for name, value in vars(arrays).items():
        np.testing.assert_array_equal(getattr(back, name), value)


def test_played_again_from_seed_and_actions_it_has_the_same_states_bit_for_bit(task, robot, whole):
    arrays = whole[2].arrays
    again = states_again(task, robot, arrays.human_actions, seed=SEED)
    np.testing.assert_array_equal(again, arrays.states)


def test_the_same_hand_plays_the_same_episode_bit_for_bit(task, robot, whole):
    for name, value in vars(played(task, robot)[2].arrays).items():
        np.testing.assert_array_equal(value, getattr(whole[2].arrays, name))


def test_it_is_what_a_measurement_would_see(task, robot, whole):
    """The rollouts of searches, given the same actions: what is played is what is measured."""
    arrays, actions = whole[2].arrays, iter(whole[2].arrays.human_actions)
    measured = play(
        task, task.make_world(1, threads=1), np.array([SEED]),
        policy_actor(robot, 1, None), lambda _: next(actions)[None],
    )  # fmt: skip
    np.testing.assert_allclose(measured.features[:, 0], arrays.features, atol=1e-3)
    np.testing.assert_allclose(measured.reward[:, 0], arrays.rewards, atol=1e-2)


def test_a_robot_with_a_memory_remembers(itching):
    palm = untrained_palm(itching.robot)
    _, _, end = played(itching, palm)
    again = states_again(itching, palm, end.arrays.human_actions, seed=SEED)
    np.testing.assert_array_equal(again, end.arrays.states)


def test_a_target_beyond_the_reach_is_used_as_the_nearest_within_it(itching, scratcher):
    episode = PlayedEpisode(itching, scratcher, seed=SEED)
    for far in (3.0, 1e200):
        episode.advance(episode.handle.reach.centre + [0, -far, 0], age=0.0, at=0.0)
    centre, radius = episode.handle.reach
    used = np.array([row.targets for row in episode._rows])
    np.testing.assert_allclose(used, [centre + [0, -radius, 0]] * 2)


def test_a_target_within_the_ball_stays_as_it_is():
    reach = Reach(np.array([1.0, 0, 0]), 0.5)
    target = np.array([1.2, 0.3, 0.0])
    np.testing.assert_array_equal(within(reach, target), target)
    np.testing.assert_array_equal(within(reach, reach.centre), reach.centre)


@pytest.mark.parametrize("bad", [[np.nan, 0, 0], [0, np.inf, 0]])
def test_a_target_that_is_no_place_is_refused(itching, scratcher, bad):
    episode = PlayedEpisode(itching, scratcher, seed=SEED)
    with pytest.raises(ValueError, match="a target is three finite numbers"):
        episode.advance(np.array(bad, dtype=float), age=0.0, at=0.0)


def test_an_episode_ends_once(itching, scratcher):
    episode = PlayedEpisode(itching.with_parameters(horizon=1), scratcher, seed=SEED)
    with pytest.raises(ValueError, match="the episode has 0 of 1 steps"):
        episode.finish()
    episode.advance(episode.hand, age=0.0, at=0.0)
    with pytest.raises(ValueError, match="the episode is over after 1 steps"):
        episode.advance(episode.hand, age=0.0, at=0.1)


def test_physics_that_runs_away_ends_the_episode_and_counts_for_nobody(itching, scratcher):
    episode = PlayedEpisode(itching, scratcher, seed=SEED)
    for step in range(4):
        if step == 3:
            episode._world._batch.bind("qvel")[0, 12] = 1e12
        frame = episode.advance(episode.hand, age=0.0, at=0.1 * step)
    assert frame.done
    assert np.isfinite(frame.poses).all()
    end = episode.finish()
    assert end.outcome == FAULTED
    assert np.isnan([end.episode_return, end.success]).all()
    assert end.arrays.faulted.tolist() == [False] * 3 + [True]
    assert len(end.arrays.states) == 5


def test_an_unwanted_touch_is_told_with_its_force(itching, scratcher):
    episode = PlayedEpisode(itching, scratcher, seed=SEED)
    step = episode._world.step
    episode._world.step = lambda *actions: _touching(step(*actions))
    assert episode.advance(episode.hand, age=0.0, at=0.0).unwanted
    assert episode._rows[0].unwanted_force == 4.5


def _touching(step):
    return step._replace(info={**step.info, "force_unwanted": np.array([4.5])})


def test_threads_may_begin_their_first_episodes_at_the_same_moment(itching, scratcher):
    stored_posture.cache_clear()
    with ThreadPoolExecutor(8) as threads:
        episodes = list(
            threads.map(lambda seed: PlayedEpisode(itching, scratcher, seed=seed), range(8))
        )
    assert [episode.seed for episode in episodes] == list(range(8))


def test_a_task_that_nobody_can_play_says_so():
    task = ToyReach()
    with pytest.raises(UserError, match="nobody can play the human of task 'toy-reach' by hand"):
        PlayedEpisode(task, untrained_palm(task.robot), seed=0)
