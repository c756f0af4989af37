"""Where the range of adversarialness comes from, and what it does to a measurement."""

from __future__ import annotations

import hashlib
import json

import numpy as np
import pytest

from rigid.compute.preparation import prepare, settings_for
from rigid.compute.return_range import (
    ReturnRange,
    find_return_range,
    range_in_force,
    spoken_range,
    stored_range,
)
from rigid.compute.subject import Subject
from rigid.errors import UserError
from rigid.tasks.protocol import adversarialness
from tests.compute.tiny import TINY, FilmedReach
from tests.toys import ToyReach, ToyWorld


def range_file(path, for_task, **changes):
    spread = {"episodes": 2, "mean": 0.0, "se": 1.0, "quantiles": {"0.5": 0.0}}
    found = {
        "format": 1, "kind": "return-range", "task": dict(for_task.describe()), "worst": -8.0,
        "best": 2.0, "returns": {"canonical": spread, "sabotage": spread}, "provenance": {},
        **changes,
    }  # fmt: skip
    path.write_text(json.dumps(found))
    return path


@pytest.mark.parametrize(
    "given",
    ["-100,20", "-1e2, 20.0", (-100, 20), [-100.0, 20.0]],
    ids=["text", "e", "tuple", "list"],
)
def test_two_returns_are_a_range(given):
    assert find_return_range(given, ToyReach()) == ReturnRange(-100.0, 20.0, "option")


def test_a_calibrated_file_is_known_by_its_name_and_hash(tmp_path):
    path = range_file(tmp_path / "range.json", ToyReach())
    found = find_return_range(path, ToyReach())
    assert found.ends == (-8.0, 2.0)
    assert found.describe() == {
        "return_range": [-8.0, 2.0],
        "range_source": "calibrated",
        "range_file": {
            "name": "range.json", "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        },
    }  # fmt: skip


BAD_FILES = {
    "another task": ({"task": {"name": "other"}}, "is the range of another task: name is 'other'"),
    "another version": (
        {"task": {"name": "toy-reach", "version": 7}}, "version is 7 there and 0 here"
    ),
    "upside down": ({"worst": 3.0}, "worst is 3, which is not below best, 2"),
    "no number": ({"best": "high"}, "best: Input should be a valid number"),
    "newer": ({"format": 2}, "has format version 2, but this RIGID reads up to 1"),
    "of another kind": ({"kind": "canonical"}, "kind: Input should be 'return-range'"),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "message"), BAD_FILES.values(), ids=BAD_FILES)
def test_a_file_that_does_not_fit_is_refused(changes, message, tmp_path):
    path = range_file(tmp_path / "range.json", ToyReach(), **changes)
    with pytest.raises(UserError) as error:
        find_return_range(str(path), ToyReach())
    assert message in str(error.value)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            "none.json",
            "'none.json': give two returns LOW,HIGH, which map to adversarialness 1 and 0",
        ),
        ("20,-100", "is 20,-100, but must be two returns LOW,HIGH with LOW < HIGH"),
        ("1,2,3", "'1,2,3': give two returns"),
        ((1.0,), "return_range has 1 numbers, but takes (worst, best)"),
    ],
)
def test_what_is_no_range_is_refused(given, message):
    with pytest.raises(UserError) as error:
        find_return_range(given, ToyReach())
    assert message in str(error.value)


def test_without_a_range_the_message_names_both_cures():
    with pytest.raises(
        UserError, match=r"--return-range LOW,HIGH, or measure them with `rigid cal"
    ):
        range_in_force(ToyReach(return_range=None), None)


def test_the_tasks_own_range_has_no_file():
    found = range_in_force(ToyReach(), None).describe()
    assert found == {"return_range": [-20.0, 0.0], "range_source": "task", "range_file": None}
    assert stored_range(found) == ReturnRange(-20.0, 0.0, "task")


def test_the_source_is_said_in_words():
    option = ReturnRange(-100.0, 20.5, "option").describe()
    assert spoken_range(option) == "0 at a return of 20.5, 1 at -100 (a range given by the user)"
    file = ReturnRange(-8.0, 2.0, "calibrated", "r.json", "0123456789").describe()
    assert "calibrated range, r.json 01234567)" in spoken_range(file)


@pytest.fixture
def prepared(base):
    """Measurements of the toy robot up to their first adversary."""
    robot, human = (str(base / "pair" / agent) for agent in ("robot", "human"))

    def of(task, return_range=None):
        subject = Subject(task, robot, human, return_range=return_range)
        return prepare(subject, TINY, settings_for(TINY))

    return of


def test_the_range_in_force_is_the_rulers_the_tasks_and_the_identitys(prepared):
    found = prepared(FilmedReach(return_range=None), ReturnRange(-40.0, 0.0, "option"))
    assert found.ruler.return_range == found.task.return_range == (-40.0, 0.0)
    assert found.identity["return_range"] == [-40.0, 0.0]
    assert found.canonical["adversarialness"] == pytest.approx(-found.canonical["return"] / 40)


class Richer(FilmedReach):
    """The toy task with rewards in another unit."""

    def __init__(self, factor):
        super().__init__(return_range=(-20.0 * factor, 0.0))
        self.factor = factor

    def make_world(self, batch, *, threads=0):
        del threads
        return _RicherWorld(self, batch)


class _RicherWorld(ToyWorld):
    def step(self, robot_action, human_action):
        step = super().step(robot_action, human_action)
        return step._replace(reward=step.reward * self._task.factor)


@pytest.mark.parametrize("factor", [1e-9, 1e3, 1e9])
def test_adversarialness_does_not_depend_on_the_unit_of_reward(factor, prepared):
    plain, other = prepared(Richer(1.0)), prepared(Richer(factor))
    assert other.canonical["adversarialness"] == pytest.approx(plain.canonical["adversarialness"])
    assert other.opponent.reward_std == pytest.approx(factor * plain.opponent.reward_std)


@pytest.mark.slow
def test_a_frontier_does_not_depend_on_the_unit_of_reward(measure, tmp_path):
    # A power of two, which no rounding can tell: every training takes the very same steps.
    once = {"seeds": [0], "lambdas": [0, np.inf]}
    plain, other = (
        measure(tmp_path / str(factor), task=Richer(factor), **once) for factor in (1.0, 1024.0)
    )
    for mine, theirs in zip(plain.points, other.points, strict=True):
        assert mine["naturalness"] == theirs["naturalness"]
        assert mine["adversarialness"] == theirs["adversarialness"]
        assert 1024 * mine["return"] == theirs["return"]
    assert plain.auc == other.auc


def test_the_range_maps_its_ends_to_1_and_0():
    found = find_return_range("-8,2", ToyReach())
    np.testing.assert_array_equal(adversarialness(np.array([-8.0, 2.0]), found.ends), [1.0, 0.0])
