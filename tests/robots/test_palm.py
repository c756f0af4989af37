"""A PALM robot: what it leaves on disk, and that an interrupted one ends as it should."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rigid.data.episodes import load_episodes
from rigid.errors import UserError
from rigid.learning.motion_vae import MotionSettings
from rigid.learning.palm import PalmSettings
from rigid.policies.native import load_native
from rigid.policies.palm import PalmPolicy
from rigid.robots.palm import PalmRecipe, train_palm
from tests.learning.reach import ShownReach
from tests.robots.quick import PAIR, VANILLA, Seen, co_optimise, names, same
from tests.toys import ToyReach

RECIPE = PalmRecipe(
    diverse=PAIR,
    palm=PalmSettings(
        personalisation=VANILLA, motion=MotionSettings(hidden=5, latent=2, minibatch=40)
    ),
    judged_episodes=10,
)


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """Of the task whose pair sees the goal; nobody asks how well it plays."""
    short = replace(PAIR, iterations=1)
    return co_optimise(tmp_path_factory.mktemp("pair"), settings=short, task=ShownReach())


@pytest.fixture(scope="module")
def train(pair):
    def run(out, *, diverse=None, report=None, recipe=RECIPE, seed=0, task=None):
        train_palm(
            task or ShownReach(), recipe, pair=pair, seed=seed, out=out,
            canonical_episodes=5, report_diverse=diverse or Seen(), report=report or Seen(),
        )  # fmt: skip
        return out

    return run


@pytest.fixture(scope="module")
def robot(train, tmp_path_factory):
    return train(tmp_path_factory.mktemp("palm"))


def test_a_robot_keeps_its_diverse_pair_beside_it(robot):
    policies = {f"{place}policy" for place in ("", "diverse/robot/", "diverse/human/")}
    files = {f"{policy}.{kind}" for policy in policies for kind in ("json", "safetensors")}
    assert names(robot) == files | {"canonical.npz"}
    assert isinstance(load_native(robot).policy, PalmPolicy)
    assert load_native(robot / "diverse" / "human").card.task["varied"]


def test_the_card_says_who_the_partners_were_and_how_well_they_were_predicted(robot, pair):
    made_by = load_native(robot).card.provenance
    diverse = {agent: load_native(robot / "diverse" / agent).card for agent in ("human", "robot")}
    assert made_by["recipe"] == "palm"
    assert made_by["human"] == load_native(pair / "human").card.sha256
    assert made_by["expert"] == load_native(pair / "robot").card.sha256
    assert made_by["diverse"] == {
        "human": diverse["human"].sha256,
        "expert": diverse["robot"].sha256,
    }
    assert set(made_by["prediction_error"]) == {"palm", "constant_velocity"}


def test_canonical_episodes_are_those_of_the_synthetic_human_in_the_ordinary_task(robot, pair):
    episodes = load_episodes(robot / "canonical.npz", task=ShownReach())
    assert len(episodes) == 5
    assert episodes.provenance["human"] == load_native(pair / "human").card.sha256
    assert not episodes.task["varied"]


def test_interrupted_in_either_stage_it_ends_like_an_undisturbed_one(train, robot, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path, diverse=Seen(last=11))
    diverse, report = Seen(), Seen(last=11)
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path, diverse=diverse, report=report)
    assert diverse.iterations == [10, 11, 12, 13]  # From the last checkpoint on.
    with pytest.raises(UserError, match="is from a training with other settings: choose another"):
        train(tmp_path, recipe=replace(RECIPE, diverse=replace(PAIR, iterations=1)))
    diverse, report = Seen(), Seen()
    train(tmp_path, diverse=diverse, report=report)
    assert (diverse.iterations, report.iterations) == ([], [10, 11, 12, 13])
    assert (diverse.begun, report.begun[2]) == (None, 10)
    assert names(tmp_path) == names(robot)
    assert same(tmp_path, robot)


def test_a_finished_robot_is_refused(train, robot):
    with pytest.raises(UserError, match="already holds a robot: choose another directory"):
        train(robot)


def test_a_task_that_cannot_vary_its_humans_is_refused_before_any_work(train, tmp_path):
    with pytest.raises(UserError, match=r"'toy-reach' does not say which .* show the human"):
        train(tmp_path / "new", task=ToyReach())
    assert not (tmp_path / "new").exists()
