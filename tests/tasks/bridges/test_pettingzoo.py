"""PettingZoo's environments as tasks: who plays whom, what they see, do and get."""

import sys
from itertools import pairwise

import cloudpickle
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.tasks.bridges.pettingzoo import _Opener
from rigid.tasks.conformance import broken_promises
from rigid.tasks.registry import make_task, task_from_description

HERE = "pettingzoo:tests.tasks.bridges.environments"


def open_task(factory, **parameters):
    return make_task(f"{HERE}:{factory}", **parameters)


def play(task, actions, *, seeds=(1, 2, 3)):
    """An episode in which everybody always acts alike."""
    world = task.make_world(len(seeds), threads=1)
    steps = [world.reset(np.array(seeds))]
    robot = np.full((len(seeds), task.robot.action_size), actions[0])
    human = np.full((len(seeds), task.human.action_size), actions[1])
    steps += [world.step(robot, human) for _ in range(task.horizon)]
    return world, steps


@pytest.mark.parametrize(
    ("factory", "parameters"),
    [
        ("two", {}),
        ("three", {"human_agent": "bob"}),
        ("short", {}),
        ("beyond", {}),
        ("choosing", {}),
        ("taking_turns", {}),
        ("nameless", {}),
    ],
)
def test_it_keeps_the_promises_of_a_task(factory, parameters):
    assert broken_promises(open_task(factory, **parameters)) == ()


def test_agents_called_human_and_robot_are_known_by_their_names():
    task = open_task("two")
    assert task.describe()["parameters"] == {
        "human_agent": "human", "robot_agent": "robot", "horizon": 4,
    }  # fmt: skip
    assert make_task(task.name, **task.describe()["parameters"]).describe() == task.describe()


def test_agents_that_nobody_names_are_the_robot():
    task = open_task("three", human_agent="bob")
    assert task.describe()["parameters"]["robot_agent"] == "ann,cleo"
    assert (task.robot.observation_size, task.robot.action_size) == (4, 2)
    assert task.robot.observation_names == (
        "ann/observation_0", "ann/observation_1", "cleo/observation_0", "cleo/observation_1",
    )  # fmt: skip


def test_sides_are_in_the_environments_order():
    task = open_task("three", human_agent="cleo, ann")
    assert task.describe()["parameters"]["human_agent"] == "ann,cleo"


def test_agents_may_be_called_by_numbers():
    task = open_task("numbered", human_agent="1")
    _, steps = play(task, (0.0, 0.0))
    assert task.describe()["parameters"]["robot_agent"] == "0"
    assert sum(step.reward[0] for step in steps) == 4 * 1.0


def test_the_reward_is_the_sum_over_the_robots_agents():
    _, steps = play(open_task("three", human_agent="bob"), (0.0, 0.0))
    np.testing.assert_array_equal([step.reward[0] for step in steps], [0, *[1 + 21] * 4])


def test_actions_are_stretched_to_the_agents_space():
    world, steps = play(open_task("two"), (-1.0, 1.0))
    moved = steps[-1].robot_observation[:, 0] - steps[0].robot_observation[:, 0]
    np.testing.assert_allclose(moved, 4 * -2.0, rtol=1e-5)
    moved = steps[-1].human_observation[:, 0] - steps[0].human_observation[:, 0]
    np.testing.assert_allclose(moved, 4 * 6.0, rtol=1e-5)
    assert world.snapshot().shape == (3, 0)


def test_features_are_what_the_human_saw_before_a_step_and_then_did():
    task = open_task("two")
    _, steps = play(task, (0.0, 0.5))
    assert task.feature_names == ("observation_0", "observation_1", "action_0")
    for before, after in pairwise(steps):
        np.testing.assert_array_equal(after.features[:, :2], before.human_observation)
        np.testing.assert_array_equal(after.features[:, 2], 0.5)


def test_of_a_discrete_action_features_tell_the_choice_alone():
    task = open_task("choosing")
    world = task.make_world(1, threads=1)
    features = []
    for scores in ([[0.1, 0.2, 0.05]], [[-1.0, 0.9, 0.8]]):
        world.reset(np.array([1]))
        features.append(world.step(np.zeros((1, 3)), np.array(scores)).features)
    assert task.human.choices == (3,)
    np.testing.assert_array_equal(*features)
    np.testing.assert_array_equal(features[0][0, 2:], [-1, 1, -1])


@pytest.mark.parametrize("factory", ["short", "deserted"])
def test_what_ends_or_is_deserted_early_stays_as_it_is(factory):
    world, steps = play(open_task(factory), (0.0, 0.0))
    np.testing.assert_array_equal([s.reward[0] for s in steps[1:]], [11, 11, 11, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal([s.human_observation[0, 1] for s in steps[3:]], 3)
    summary = world.summary()
    np.testing.assert_array_equal(summary.outcome, 1)
    np.testing.assert_array_equal(summary.extra["steps"], 3)


def test_success_is_what_the_robots_info_says_last():
    world, _ = play(open_task("two"), (0.0, 0.0))
    summary = world.summary()
    np.testing.assert_array_equal(summary.success, 1)
    np.testing.assert_array_equal(summary.outcome, 0)
    assert np.isnan(summary.peak_force).all()


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    ("factory", "message"),
    [
        (
            "growing",
            r"at step 1 of the episode of seed 0: .*an observation has 3 numbers, but its .*2",
        ),
        ("very_successful", r"at step 1 of .*info has is_success 2, but must have 0 or 1"),
    ],
)
def test_answers_that_are_not_as_promised_are_refused_with_their_place(factory, message, threads):
    world = open_task(factory).make_world(16, threads=threads)
    world.reset(np.arange(16))
    with pytest.raises(UserError, match=message):
        world.step(*np.zeros((2, 16, 1)))


def test_the_horizon_may_be_shorter_and_longer_than_the_environments():
    assert open_task("two", horizon=2).horizon == 2
    assert open_task("short", horizon=20).horizon == 20


def test_an_edited_module_is_another_task(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.path", sys.path[:])
    text = "from tests.tasks.bridges.environments import room, two\n"
    module = tmp_path / "edited_tasks.py"
    names = ("pettingzoo:edited_tasks:two", "gymnasium:edited_tasks:room")
    module.write_text(text)
    before = [make_task(name).describe() for name in names]
    assert [make_task(name).describe() for name in names] == before
    module.write_text(text + "GAIN = 2\n")
    for name, described in zip(names, before, strict=True):
        now = make_task(name).describe()
        assert now["version"] != described["version"]
        assert {**now, "version": 0} == {**described, "version": 0}


def test_the_control_period_is_that_of_its_pictures():
    assert open_task("two").control_period == 1 / 20


def test_it_goes_to_other_processes_without_its_environments():
    task = open_task("two")
    task.make_world(2, threads=1).reset(np.arange(2))
    assert cloudpickle.loads(cloudpickle.dumps(task)).describe() == task.describe()
    assert len(cloudpickle.dumps(task)) < 5000


def test_nothing_is_imported_for_a_foreign_run_directory():
    assert task_from_description({"name": f"{HERE}:two", "parameters": {}}) is None


@pytest.mark.parametrize(
    ("factory", "parameters", "message"),
    [
        ("three", {}, r"who is the human\? .*; agents: ann, bob, cleo"),
        ("three", {"human_agent": "dan"}, r"--human-agent 'dan' is no agent; agents: ann, bob"),
        ("three", {"robot_agent": "dan"}, r"--robot-agent 'dan' is no agent"),
        ("three", {"human_agent": "ann", "robot_agent": "ann"}, r"'ann' cannot be both"),
        ("three", {"human_agent": "ann", "robot_agent": "bob"}, r"nobody plays cleo: add"),
        ("three", {"human_agent": "ann,bob,cleo"}, r"nobody is left for the robot"),
        ("numbered", {}, r"who is the human\?"),
        ("endless", {}, r"does not say how long an episode is .*--horizon STEPS"),
        ("two", {"horizon": 0}, r"horizon is 0, but an episode has at least 1 step"),
        ("unbounded", {}, r"unbounded: action space Box\(-inf.*of agent 'robot' has no finite"),
        ("turns", {}, r"gives an AECEnv whose agents take turns"),
        ("room", {}, r"one agent: name it as gymnasium:tests\.tasks\.bridges\.environments:room"),
        ("nothing", {}, r"gives a int without reset\(\), but must give a PettingZoo ParallelEnv"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_cure(factory, parameters, message):
    with pytest.raises(UserError, match=message):
        open_task(factory, **parameters)


def test_a_parameter_that_it_does_not_have_is_refused():
    with pytest.raises(UserError, match=r"unknown parameter 'human_agnt', did you mean 'human_"):
        open_task("two", human_agnt="a")


def test_an_environment_that_shows_an_agent_nothing_is_refused():
    world = _Opener(f"{HERE}:two", ".", ("human",), ("robot",))()
    world._env.observation_space = None
    world._env._seen = dict
    with pytest.raises(UserError, match=r"shows nothing to '(human|robot)'"):
        world.reset(1)
