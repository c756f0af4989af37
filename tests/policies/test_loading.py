"""What may stand after `--robot` and `--human`, and what is said to everything else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigid.compute.subject import Subject, canonical_path
from rigid.errors import UserError
from rigid.policies import loading
from rigid.policies.loading import builtin_names, load_policy, policy_hash
from rigid.policies.native import save_policy
from rigid.policies.opening import NAMED_BY_FILE, Opening
from rigid.policies.passive import PassivePolicy
from tests.toys import ToyReach, untrained

TASK = ToyReach()


def store(directory, agent="robot", task=TASK, **options):
    policy = untrained(getattr(task, agent), **options)
    save_policy(policy, directory, agent=agent, task=task.describe(), provenance={})
    return policy


@pytest.fixture
def bundled(tmp_path, monkeypatch):
    """A package that ships two robots and a human for the toy task."""
    folder = tmp_path / "bundled"
    monkeypatch.setattr(loading, "BUNDLED", folder)
    store(folder / TASK.name / "vanilla", seed=1)
    store(folder / TASK.name / "co-optimised", seed=2)
    store(folder / TASK.name / "synthetic-human", agent="human", seed=3)
    (folder / TASK.name / "canonical.npz").touch()
    return folder


@pytest.mark.parametrize("agent", ["robot", "human"])
def test_a_native_directory_is_loaded(tmp_path, agent):
    policy = store(tmp_path / "mine", agent)
    loaded = load_policy(str(tmp_path / "mine"), task=TASK, agent=agent)
    assert policy_hash(loaded) == policy_hash(policy)


def test_builtin_policies_come_with_the_package(bundled):
    loaded = load_policy("builtin:vanilla", task=TASK, agent="robot")
    assert policy_hash(loaded) == policy_hash(bundled / TASK.name / "vanilla")


@pytest.mark.usefixtures("bundled")
def test_builtin_names_are_those_of_the_agent():
    assert builtin_names(TASK, "robot") == ("co-optimised", "vanilla")
    assert builtin_names(TASK, "human") == ("passive", "synthetic-human")


def test_a_task_without_bundled_policies_has_the_passive_human():
    assert builtin_names(TASK, "robot") == ()
    assert builtin_names(TASK, "human") == ("passive",)


def test_the_passive_human_fits_every_task_and_does_nothing():
    passive = load_policy("builtin:passive", task=TASK, agent="human")
    rng = np.random.default_rng(0)
    action, state = passive.act(np.ones((4, 3)), passive.initial_state(4), rng)
    np.testing.assert_array_equal(action, np.zeros((4, 1)))
    assert state == ()


@pytest.mark.usefixtures("bundled")
@pytest.mark.parametrize(
    ("spec", "agent", "message"),
    [
        pytest.param(
            "builtin:vanila",
            "robot",
            "robot 'builtin:vanila' is unknown for task 'toy-reach'; did you mean "
            "'builtin:vanilla'\\?; builtin robots: builtin:co-optimised, builtin:vanilla$",
            id="misspelt",
        ),
        pytest.param(
            "builtin:zzz",
            "robot",
            "unknown for task 'toy-reach'; builtin robots: builtin:co-optimised",
            id="nothing-like-it",
        ),
        pytest.param(
            "builtin:passive", "robot", "robot 'builtin:passive' is unknown", id="only-humans"
        ),
        pytest.param(
            "builtin:../toy-reach/vanilla", "robot", "is unknown for task", id="no-way-out"
        ),
        pytest.param(
            "builtin:canonical.npz", "robot", "is unknown for task", id="file-beside-policies"
        ),
        pytest.param(
            "vanilla", "robot", "is no directory; did you mean 'builtin:vanilla'", id="no-prefix"
        ),
        pytest.param(
            "arm.zip",
            "robot",
            "'arm.zip' is no directory; did you mean 'sb3:arm.zip', with --trust",
            id="no-kind-of-zip",
        ),
        pytest.param(
            "Arm.PT",
            "human",
            "'Arm.PT' is no directory; did you mean 'torchscript:Arm.PT', with --trust",
            id="no-kind-of-pt",
        ),
        pytest.param(
            "runs/v1.2",
            "robot",
            "'runs/v1.2' is no directory: give builtin:NAME, a native policy directory, "
            "FILE.onnx, sb3:FILE.zip, .* or exec:COMMAND$",
            id="no-file",
        ),
        pytest.param(
            "tf:arm.pb",
            "human",
            "human 'tf:arm.pb' is of kind 'tf', which is unknown: give builtin:NAME",
            id="no-kind",
        ),
        pytest.param(
            "python: ", "robot", "names nothing: write python:MODULE:FACTORY", id="no-place"
        ),
    ],
)
def test_an_unknown_policy_is_refused_with_what_is_known(spec, agent, message):
    with pytest.raises(UserError, match=message):
        load_policy(spec, task=TASK, agent=agent)


@pytest.mark.parametrize(
    "spec", ["python:os:getcwd", "exec:touch mark", "sb3:arm.zip", "torchscript:arm.pt"]
)
def test_a_name_in_a_file_is_never_taken_for_a_command(spec, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UserError, match=f"robot '{spec}' would run code that a file names: name"):
        load_policy(spec, task=TASK, agent="robot", opening=replace(NAMED_BY_FILE, trust=True))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "name"), [({"frames": 4}, "frames"), ({"vecnormalize": Path("v.pkl")}, "vecnorm")]
)
def test_what_only_sb3_robots_take_is_not_ignored_for_others(tmp_path, options, name):
    store(tmp_path)
    with pytest.raises(UserError, match=rf"--{name}\w* is for sb3:FILE\.zip, but the robot is"):
        load_policy(str(tmp_path), task=TASK, agent="robot", opening=Opening(**options))


def test_the_robots_normaliser_and_frames_are_not_the_humans(monkeypatch):
    given = []

    def open_it(place, wanted, opening):
        given.append((place, opening))
        return PassivePolicy(wanted.sizes.observation_size, wanted.sizes.action_size)

    monkeypatch.setattr(loading, "_KINDS", {"sb3": loading._Kind("", open_it, runs_code=True)})
    both = Opening(trust=True, vecnormalize=Path("v.pkl"), frames=4)
    for agent in ("robot", "human"):
        load_policy("sb3:a.zip", task=TASK, agent=agent, opening=both)
    assert given == [("a.zip", both), ("a.zip", Opening(trust=True))]


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        (f"exec:no-such-program {'x' * 5000}", "cannot be started: no-such-program"),
        ("x" * 5000, "is no directory: give builtin:NAME"),
    ],
)
def test_a_name_too_long_for_a_file_is_no_crash(spec, message):
    with pytest.raises(UserError, match=message):
        load_policy(spec, task=TASK, agent="robot")
    with loading.native_directory(spec, TASK) as directory:
        assert directory is None
    assert canonical_path(Subject(TASK, spec)) is None


def test_a_task_without_bundled_robots_says_so():
    with pytest.raises(
        UserError,
        match="builtin robots: none; train a pair with `rigid train co-optimize --task toy-reach "
        "--out DIR`, or name yours",
    ):
        load_policy("builtin:vanilla", task=TASK, agent="robot")


@pytest.mark.parametrize("agent", ["robot", "human"])
def test_the_directory_of_a_pair_says_which_of_the_two_to_name(agent, tmp_path):
    policy = untrained(getattr(TASK, agent))
    save_policy(policy, tmp_path / agent, agent=agent, task=TASK.describe(), provenance={})
    with pytest.raises(UserError, match=f"holds no policy itself: name '.*/{agent}' in it"):
        load_policy(str(tmp_path), task=TASK, agent=agent)


def test_a_policy_of_other_sizes_is_refused_with_both(tmp_path):
    save_policy(untrained(TASK.human), tmp_path, agent="robot", task=TASK.describe(), provenance={})
    message = "maps 3 observations to 1 actions, but the robot of 'toy-reach' maps 2 to 1: choose a"
    with pytest.raises(UserError, match=message):
        load_policy(str(tmp_path), task=TASK, agent="robot")


def test_the_other_agents_policy_is_refused(tmp_path):
    store(tmp_path, "human")
    with pytest.raises(UserError, match="is a policy of the human: choose a robot's"):
        load_policy(str(tmp_path), task=TASK, agent="robot")


def test_another_tasks_policy_is_refused_with_both_names(tmp_path):
    store(tmp_path, task=ToyReach(name="toy-other"))
    with pytest.raises(UserError, match="was trained for task 'toy-other', not 'toy-reach'"):
        load_policy(str(tmp_path), task=TASK, agent="robot")


def test_a_policy_of_the_task_with_other_parameters_is_taken(tmp_path):
    store(tmp_path, task=ToyReach(horizon=5))
    assert load_policy(str(tmp_path), task=TASK, agent="robot").observation_size == 2


def test_a_folder_without_a_policy_is_refused(tmp_path):
    with pytest.raises(UserError, match=r"policy\.json does not exist: a native policy is"):
        load_policy(str(tmp_path), task=TASK, agent="robot")


def test_policies_that_differ_have_different_hashes():
    policies = [
        untrained(TASK.robot, seed=0),
        untrained(TASK.robot, seed=1),
        untrained(TASK.robot, seed=0, memory=2),
        PassivePolicy(2, 1),
        PassivePolicy(3, 1),
    ]
    assert len({policy_hash(policy) for policy in policies}) == len(policies)
    assert all(len(policy_hash(policy)) == 64 for policy in policies)


def test_a_policy_without_weights_has_no_hash():
    class Stranger:
        observation_size, action_size = 1, 1
        initial_state, act = PassivePolicy.initial_state, PassivePolicy.act

    with pytest.raises(TypeError, match="a Stranger has no weights to hash"):
        policy_hash(Stranger())
