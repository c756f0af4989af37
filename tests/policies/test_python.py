"""Robots that a user's Python module makes, and what is said where it does not."""

from __future__ import annotations

import sys

import cloudpickle
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.policies.loading import load_policy, policy_hash
from tests.toys import ToyReach

TASK = ToyReach()
SOURCE = """
import threading
import numpy as np

class Robot:
    def __init__(self):
        self.lock = threading.Lock()  # Cannot be pickled.
    def initial_state(self, batch):
        return np.zeros((batch, 1))
    def act(self, observation, state, rng):
        noise = 0.0 if rng is None else rng.standard_normal(state.shape)
        state = state + observation[:, :1] + noise
        return state, state

class Wide(Robot):
    observation_size, action_size = 5, 1

class Many(Robot):
    def act(self, observation, state, rng):
        return np.zeros((len(observation), 4)), state

class Scribbling(Robot):
    def act(self, observation, state, rng):
        observation *= 0
        return observation[:, :1], state

class Guessing(Robot):
    def act(self, observation, state, rng):
        return np.random.standard_normal((len(observation), 1)), state

class Mixing(Robot):
    def act(self, observation, state, rng):
        return observation[:, :1] - observation[:, :1].mean(), state

class Ragged(Robot):
    def act(self, observation, state, rng):
        return [[0.0], [0.0, 1.0]], state

class Unbegun(Robot):
    def initial_state(self, batch):
        raise KeyError("hand")

class Stating(Robot):
    action_size = 2

class Chooser(Robot):
    def act(self, observation, state, rng):
        return np.zeros(len(observation), int), state

class Bare(Robot):
    def act(self, observation, state, rng):
        return state

class Odd(Robot):
    observation_size = "two"

class Named(Robot):
    def fingerprint(self):
        return "7"

class Breaking(Robot):
    def act(self, observation, state, rng):
        return observation["hand"], state

def broken():
    return 1 / 0

number = 5
"""
MADE = ("Robot", "Scribbling", "Named")


@pytest.fixture
def module(here, monkeypatch):
    """Writes a module that no other test has imported; gives its name."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    name = f"robots_{here.name}"

    def write(text=SOURCE):
        sys.modules.pop(name, None)
        (here / f"{name}.py").write_text(text)
        return name

    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    yield write
    sys.modules.pop(name, None)


def load(spec, agent="robot"):
    return load_policy(spec, task=TASK, agent=agent)


def test_the_module_is_found_in_the_working_directory_and_its_robot_remembers(module):
    policy = load(f"python:{module()}:Robot")
    state = policy.initial_state(2)
    _, state = policy.act(np.array([[0.1, 0.0], [0.2, 0.0]]), state, None)
    action, _ = policy.act(np.array([[0.1, 0.0], [0.2, 0.0]]), state, None)
    np.testing.assert_allclose(action, [[0.2], [0.4]])


def test_a_human_is_given_the_generator(module):
    policy = load(f"python:{module()}:Robot", agent="human")
    seen, state = np.zeros((1, 3)), policy.initial_state(1)
    actions = [policy.act(seen, state, np.random.default_rng(seed))[0] for seed in (0, 0, 1)]
    assert actions[0] == actions[1]
    assert actions[0] != actions[2]


def test_another_process_makes_its_own_robot(module):
    policy = load(f"python:{module()}:Robot")
    sent = cloudpickle.loads(cloudpickle.dumps(policy))
    action, _ = sent.act(np.array([[0.1, 0.0]]), sent.initial_state(1), None)
    np.testing.assert_allclose(action, [[0.1]])
    assert sent.fingerprint() == policy.fingerprint()


def test_the_hash_follows_source_factory_and_the_robots_own(module):
    name = module()
    hashes = [policy_hash(load(f"python:{name}:{made}")) for made in MADE]
    module(SOURCE + "# Another version.\n")
    hashes.append(policy_hash(load(f"python:{name}:Robot")))
    module(SOURCE.replace('"7"', '"8"'))
    hashes.append(policy_hash(load(f"python:{name}:Named")))
    assert len(set(hashes)) == 5


def test_a_source_that_changed_on_the_way_to_another_process_is_refused(module):
    policy = load(f"python:{module()}:Robot")
    sent = cloudpickle.dumps(policy)
    module(SOURCE + "# Another version.\n")
    there = cloudpickle.loads(sent)
    with pytest.raises(UserError, match="its source was changed in the meantime"):
        there.initial_state(1)


@pytest.mark.parametrize(
    ("factory", "message"),
    [
        ("Nobody", r"the module has no 'Nobody': write python:MODULE:FACTORY, as"),
        ("number", "is a int, but must be a function: write python:MODULE:FACTORY"),
        (
            "broken",
            r"the factory fails: ZeroDivisionError: division by zero \(.*\.py:\d+\)$",
        ),
        ("threading.Lock", "gives a .* without initial_state\\(…\\): a policy has initial_state"),
        ("Wide", "maps 5 observations to 1 actions, but the robot of 'toy-reach' maps 2 to 1"),
        ("Odd", "observation_size is 'two', but must be a whole number from 1"),
        ("Stating", "states action_size 2, but answers 1 numbers"),
        ("Many", "maps 2 observations to 4 actions, but the robot of 'toy-reach' maps 2 to 1"),
        ("Chooser", "answers whole numbers, as for discrete actions"),
        ("Bare", r"act returned a ndarray, but must return \(action, state\)"),
        ("Breaking", r"robot 'python:.*:Breaking': act fails: IndexError: only integers.*\.py:\d+"),
        ("Unbegun", "robot 'python:.*:Unbegun': initial_state fails: KeyError: 'hand'"),
        ("Ragged", "robot 'python:.*:Ragged': cannot answer .ValueError: setting an array element"),
        ("Guessing", "answers the same observations in two ways: export its mean action"),
        ("Mixing", "answers differently in another row of the batch"),
    ],
)
def test_what_is_no_robot_is_refused(module, factory, message):
    with pytest.raises(UserError, match=message):
        load(f"python:{module()}:{factory}")


def test_an_error_in_a_later_step_names_robot_and_step(module):
    text = SOURCE + "\nclass Tiring(Robot):\n    def act(self, observation, state, rng):\n"
    text += "        assert (observation < 5).all(), 'too far'\n        return state, state\n"
    policy = load(f"python:{module(text)}:Tiring")
    _, state = policy.act(np.zeros((2, 2)), policy.initial_state(2), None)
    message = r"robot 'python:.*:Tiring', step 2: act fails: AssertionError: too far"
    with pytest.raises(UserError, match=message):
        policy.act(np.full((2, 2), 9.0), state, None)


def test_a_robot_that_writes_on_what_it_sees_changes_nothing_for_others(module):
    policy = load(f"python:{module()}:Scribbling")
    seen = np.ones((2, 2), np.float32)
    policy.act(seen, policy.initial_state(2), None)
    np.testing.assert_array_equal(seen, np.ones((2, 2)))


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("no_such_module:make", "there is no module 'no_such_module', neither in .* nor installed"),
        ("./robots.py:make", "names no factory in a module: write python:MODULE:FACTORY"),
        ("json", "names no factory in a module: write python:MODULE:FACTORY"),
    ],
)
@pytest.mark.usefixtures("here")
def test_a_place_that_there_is_not_is_refused(monkeypatch, spec, message):
    monkeypatch.setattr(sys, "path", [*sys.path])
    with pytest.raises(UserError, match=message):
        load(f"python:{spec}")


def test_a_module_that_cannot_be_imported_says_where(module):
    with pytest.raises(UserError, match=r"importing robots_.* fails: SyntaxError: .*robots_"):
        load(f"python:{module('def')}:make")


def test_a_missing_module_of_the_module_is_the_one_that_is_named(module):
    with pytest.raises(UserError, match="ModuleNotFoundError: No module named 'no_such_thing'"):
        load(f"python:{module('import no_such_thing')}:make")


def test_a_folder_is_no_module(here, monkeypatch):
    monkeypatch.setattr(sys, "path", [*sys.path])
    (here / "just_a_folder_of_mine").mkdir()
    with pytest.raises(UserError, match="'just_a_folder_of_mine' is a folder, no module"):
        load("python:just_a_folder_of_mine:make")
