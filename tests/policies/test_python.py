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
    hashes = [policy_hash(load(f"python:{name}:{made}")) for made in ("Robot", "Many", "Named")]
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
        ("Odd", "observation_size is 'two', but must be a number"),
    ],
)
def test_what_is_no_robot_is_refused(module, factory, message):
    with pytest.raises(UserError, match=message):
        load(f"python:{module()}:{factory}")


@pytest.mark.parametrize(
    ("factory", "message"),
    [
        ("Many", r"step 1: answers an array of shape \(2, 4\), but the task takes \(2, 1\)$"),
        ("Chooser", "step 1: answers whole numbers, as for discrete actions"),
        ("Bare", r"act returned a ndarray, but must return \(action, state\)"),
        ("Breaking", r"step 1: act fails: IndexError: only integers.*\(.*\.py:\d+\)$"),
    ],
)
def test_what_is_no_action_is_refused_at_the_first_step(module, factory, message):
    policy = load(f"python:{module()}:{factory}")
    with pytest.raises(UserError, match=message):
        policy.act(np.zeros((2, 2)), policy.initial_state(2), None)


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
