"""Recipes: what they leave on disk, and that an interrupted one ends like an undisturbed one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rigid.data.episodes import load_episodes
from rigid.errors import UserError
from rigid.policies.native import load_native, save_policy
from rigid.robots.vanilla import train_vanilla
from tests.robots.quick import ITERATIONS, PAIR, VANILLA, Seen, co_optimise, names, same
from tests.toys import ToyReach, untrained_palm


@pytest.fixture(scope="module")
def vanilla(pair):
    """Trains a robot for `pair`."""

    def train(out, report=None, settings=VANILLA, seed=0, pair=pair):
        train_vanilla(
            ToyReach(), settings, pair=pair, seed=seed, out=out, canonical_episodes=5,
            report=report or Seen(),
        )  # fmt: skip
        return out

    return train


@pytest.fixture(scope="module")
def robot(vanilla, tmp_path_factory):
    return vanilla(tmp_path_factory.mktemp("robot"))


def test_a_pair_is_two_policies_of_their_agents(pair):
    policy = {"policy.json", "policy.safetensors"}
    assert names(pair) == {f"{agent}/{file}" for agent in ("human", "robot") for file in policy}
    for agent in ("human", "robot"):
        assert load_native(pair / agent).card.agent == agent


def test_the_human_keeps_the_noise_of_the_end_of_training(pair):
    human = load_native(pair / "human").policy
    np.testing.assert_allclose(np.exp(human.parameters.log_std), PAIR.std[1], rtol=1e-5)


def test_a_robot_comes_with_canonical_episodes(robot):
    assert names(robot) == {"policy.json", "policy.safetensors", "canonical.npz"}
    assert len(load_episodes(robot / "canonical.npz", task=ToyReach())) == 5
    assert load_native(robot).policy.memory == VANILLA.memory


def test_every_policy_says_how_it_was_made(pair, robot):
    human = load_native(pair / "human").card
    assert human.provenance["recipe"] == "co-optimize"
    assert human.provenance["seed"] == 0
    assert human.provenance["settings"]["iterations"] == ITERATIONS
    made_by = load_native(robot).card.provenance
    assert made_by["recipe"] == "vanilla"
    assert made_by["human"] == human.sha256
    assert made_by["expert"] == load_native(pair / "robot").card.sha256


def test_an_interrupted_pair_ends_like_an_undisturbed_one(pair, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        co_optimise(tmp_path, Seen(last=11))
    seen = Seen()
    co_optimise(tmp_path, seen)
    assert seen.iterations == [10, 11, 12, 13]  # From the last checkpoint on.
    assert seen.begun == (ToyReach().horizon, PAIR.episodes, 10)
    assert names(tmp_path) == names(pair)
    for agent in ("human", "robot"):
        assert same(tmp_path / agent, pair / agent)


def test_an_interrupted_robot_ends_like_an_undisturbed_one(vanilla, robot, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        vanilla(tmp_path, Seen(last=11))
    assert names(tmp_path) == {"checkpoint.safetensors"}
    seen = Seen()
    vanilla(tmp_path, seen)
    assert seen.iterations == [10, 11, 12, 13]
    assert seen.begun == (ToyReach().horizon, VANILLA.episodes, 10)
    assert names(tmp_path) == names(robot)
    assert same(tmp_path, robot)
    assert (tmp_path / "canonical.npz").read_bytes() == (robot / "canonical.npz").read_bytes()


def test_other_seeds_make_other_policies(pair, tmp_path):
    assert not same(co_optimise(tmp_path, seed=1) / "human", pair / "human")


def test_finished_directories_are_refused(pair, robot, vanilla):
    with pytest.raises(UserError, match="already holds a finished pair: choose another directory"):
        co_optimise(pair)
    with pytest.raises(UserError, match="already holds a robot: choose another directory"):
        vanilla(robot)


@pytest.mark.parametrize("name", ["robot", "canonical.npz"])
def test_a_directory_of_something_else_is_refused_and_left_alone(vanilla, tmp_path, name):
    """A pair would write robot/, a robot canonical.npz."""
    (tmp_path / name).write_text("mine")
    for train in (co_optimise, vanilla):
        with pytest.raises(UserError, match=r"is not empty and holds no training .*with --out"):
            train(tmp_path)
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


def test_what_a_training_left_that_was_killed_at_its_first_write_does_not_count(tmp_path):
    (tmp_path / ".checkpoint.safetensors.4711.tmp").touch()
    co_optimise(tmp_path, settings=replace(PAIR, iterations=1))
    assert (tmp_path / "human").exists()


@pytest.mark.parametrize(
    "changes",
    [
        {"seed": 1},
        {"settings": replace(PAIR, iterations=20)},
        {"settings": replace(PAIR, hidden=(7,))},
        {"task": ToyReach(horizon=11)},
    ],
    ids=["seed", "settings", "networks", "task"],
)
def test_a_checkpoint_of_another_training_is_refused(tmp_path, changes):
    with pytest.raises(KeyboardInterrupt):
        co_optimise(tmp_path, Seen(last=9))
    with pytest.raises(UserError, match="is from a training with other settings: choose another"):
        co_optimise(tmp_path, **changes)


def test_a_truncated_checkpoint_is_refused(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        co_optimise(tmp_path, Seen(last=9))
    path = tmp_path / "checkpoint.safetensors"
    path.write_bytes(path.read_bytes()[:500])
    with pytest.raises(UserError, match=r"is damaged .*: delete this file to train from the start"):
        co_optimise(tmp_path)


def test_a_directory_that_holds_no_pair_is_refused(vanilla, tmp_path):
    with pytest.raises(UserError, match=r"holds no human/: give a directory of `rigid train co-op"):
        vanilla(tmp_path / "robot", pair=tmp_path)


def test_a_pair_of_another_task_is_refused(vanilla, tmp_path):
    other = co_optimise(
        tmp_path / "pair", settings=replace(PAIR, iterations=1), task=ToyReach(name="other")
    )
    with pytest.raises(UserError, match="was trained for task 'other', not 'toy-reach'"):
        vanilla(tmp_path / "robot", pair=other)


def test_a_pair_with_a_human_of_another_kind_is_refused(vanilla, tmp_path):
    task = ToyReach()
    save_policy(
        untrained_palm(task.human), tmp_path / "pair" / "human",
        agent="human", task=task.describe(), provenance={},
    )  # fmt: skip
    with pytest.raises(UserError, match="human holds a PalmPolicy, as no pair does: give a dir"):
        vanilla(tmp_path / "robot", pair=tmp_path / "pair")
