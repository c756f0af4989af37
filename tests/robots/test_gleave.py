"""A robot for a population: who belongs to it, and that an interrupted one ends as it should."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rigid.data.episodes import load_episodes
from rigid.errors import UserError
from rigid.policies.native import load_native
from rigid.robots.gleave import GleaveSettings, train_gleave
from tests.robots.quick import PAIR, VANILLA, Seen, kinship, names, same
from tests.toys import ToyReach

SETTINGS = GleaveSettings(population=PAIR, personalisation=VANILLA)


@pytest.fixture(scope="module")
def train(pair):
    def run(out, *, population=None, report=None, settings=SETTINGS):
        train_gleave(
            ToyReach(), settings, pair=pair, seed=0, out=out, canonical_episodes=5,
            report_population=population or Seen(), report=report or Seen(),
        )  # fmt: skip
        return out

    return run


@pytest.fixture(scope="module")
def robot(train, tmp_path_factory):
    return train(tmp_path_factory.mktemp("gleave"))


def test_a_robot_keeps_its_population_beside_it(robot):
    population = [f"population/{name}" for name in ("robot", "human-1", "human-2")]
    policies = {f"{place}policy.json" for place in ("", *(f"{name}/" for name in population))}
    weights = {name.replace("json", "safetensors") for name in policies}
    assert names(robot) == policies | weights | {"canonical.npz"}


def test_the_synthetic_human_is_the_pairs_and_the_others_are_not(robot, pair):
    synthetic = load_native(pair / "human").card.sha256
    assert load_native(robot).card.provenance["human"] == synthetic
    canonical = load_episodes(robot / "canonical.npz", task=ToyReach())
    assert canonical.provenance["human"] == synthetic
    humans = {load_native(robot / "population" / f"human-{i}").card.sha256 for i in (1, 2)}
    assert len(humans | {synthetic}) == 3


@pytest.mark.parametrize("name", ["human-1", "human-2"])
def test_with_the_pairs_own_seed_the_others_are_no_relatives_of_its_human(robot, pair, name):
    assert abs(kinship(robot / "population" / name, pair / "human")) < 0.9


def test_with_other_settings_a_finished_population_is_not_taken_over(train, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path, report=Seen(last=2))
    shorter = replace(SETTINGS, population=replace(PAIR, iterations=2))
    with pytest.raises(UserError, match=r"human-2 is from a training with other settings: choose"):
        train(tmp_path, settings=shorter)


def test_interrupted_in_either_stage_it_ends_like_an_undisturbed_one(train, robot, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path, population=Seen(last=11))
    population, report = Seen(), Seen(last=11)
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path, population=population, report=report)
    assert population.iterations == [10, 11, 12, 13]  # From the last checkpoint on.
    population, report = Seen(), Seen()
    train(tmp_path, population=population, report=report)
    assert (population.iterations, report.iterations) == ([], [10, 11, 12, 13])
    assert (population.begun, report.begun[2]) == (None, 10)
    assert names(tmp_path) == names(robot)
    assert same(tmp_path, robot)


def test_a_finished_robot_is_refused(train, robot):
    with pytest.raises(UserError, match="already holds a robot: choose another directory"):
        train(robot)
