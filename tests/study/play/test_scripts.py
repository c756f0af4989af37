"""Scripted players do what their names say."""

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.policies.loading import load_policy
from rigid.study.play.episode import PlayedEpisode
from rigid.study.play.scripts import SCRIPT_NAMES, SPEED, TREMBLE, script
from rigid.tasks.registry import make_task


def play(task, robot, name, seed=2):
    """The way of the hand (T1, 3) [m], the episode and how it ended."""
    episode, mover = PlayedEpisode(task, robot, seed=seed), script(name)
    frames = [episode.begin()]
    while not frames[-1].done:
        target = mover.target(frames[-1].step, frames[-1].hand, episode)
        frames.append(episode.advance(target, age=0.0, at=0.0))
    return np.array([frame.hand for frame in frames]), episode, episode.finish()


def distances(hands, episode):
    return np.linalg.norm(hands - episode.handle.reach.centre, axis=1)


def test_extend_stretches_out_and_retreat_draws_back(itching, scratcher):
    out, episode, _ = play(itching, scratcher, "extend")
    back, *_ = play(itching, scratcher, "retreat")
    assert distances(out, episode)[-1] > distances(out, episode)[0] + 0.05
    assert distances(back, episode)[-1] < distances(back, episode)[0] - 0.1


def test_their_targets_are_no_faster_than_they_say(itching, scratcher):
    for name in ("extend", "retreat"):
        targets = play(itching, scratcher, name)[2].arrays.targets
        steps = np.linalg.norm(np.diff(targets, axis=0), axis=1)
        assert steps.max() <= SPEED * itching.control_period + 1e-9


def test_still_stays(itching, scratcher):
    targets = play(itching, scratcher, "still")[2].arrays.targets
    np.testing.assert_array_equal(targets, np.tile(targets[0], (len(targets), 1)))


def test_tremble_shakes_to_either_side_of_the_start(itching, scratcher):
    hands, _, end = play(itching, scratcher, "tremble")
    targets = end.arrays.targets[:, 2] - hands[0, 2]
    np.testing.assert_allclose(np.abs(targets), TREMBLE)
    assert np.sign(targets[:6]).tolist() == [-1, -1, 1, 1, -1, -1]
    assert np.ptp(hands[5:, 2]) > 0.01


def test_follow_is_helped_as_the_synthetic_human_is():
    task = make_task("itch-scratching").with_parameters(horizon=60)
    robot = load_policy("builtin:vanilla", task=task)
    assert play(task, robot, "follow", seed=0)[2].success == 1.0


@pytest.mark.parametrize("name", SCRIPT_NAMES)
def test_every_script_can_play_a_head_as_well(name):
    task = make_task("feeding").with_parameters(horizon=10)
    robot = load_policy("builtin:vanilla", task=task)
    assert not play(task, robot, name)[2].arrays.faulted.any()


def test_an_unknown_script_is_refused_by_name():
    with pytest.raises(UserError, match=r"script 'wave' is unknown: choose one of extend, retreat"):
        script("wave")
