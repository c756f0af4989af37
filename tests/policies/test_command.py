"""Policies in programs of the user's: `exec:COMMAND`."""

import pickle

import cloudpickle
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.policies.command import open_command
from rigid.policies.foreign import Wanted
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import AgentSpec
from tests.serving.programs import DOUBLER, children, write_program
from tests.toys import ToyReach

COUNTER = """
    import numpy as np
    import rigid_serve

    def act(observation, state):
        return state[:, None] / 10, state + 1

    rigid_serve.serve_policy(
        act, observation_size=2, action_size=1, initial_state=lambda batch: np.zeros(batch)
    )
"""
"""Answers the number of the step, over ten."""

NOISY = """
    import numpy as np
    import rigid_serve

    def act(observation, rng):
        mean = observation[:, :1]
        return mean if rng is None else mean + 0.1 * rng.standard_normal(mean.shape)

    rigid_serve.serve_policy(act, observation_size=2, action_size=1, samples=True)
"""

CHOOSER = """
    import numpy as np
    import rigid_serve

    rigid_serve.serve_policy(
        lambda observation: (observation[:, 0] > 0).astype(int), observation_size=2, choices=[2]
    )
"""


def serving(expression):
    """A program whose `act` is this expression of `observation`."""
    return f"""
        import numpy as np
        import rigid_serve
        rigid_serve.serve_policy(
            lambda observation: {expression}, observation_size=2, action_size=1
        )
    """


@pytest.fixture
def load(tmp_path):
    """The robot that a program serves; for `ToyReach`, or one with a choice of two."""

    def robot(text, *, choices=()):
        task = ToyReach()
        if choices:
            task.robot = AgentSpec(2, sum(choices), choices=choices)
        return load_policy(f"exec:{write_program(tmp_path, text)}", task=task, agent="robot")

    return robot


OBSERVATION = np.array([[0.5, 0.0], [-1.0, 0.0], [0.25, 0.0]], np.float32)


def test_it_acts_for_many_worlds_at_once(load):
    robot = load(DOUBLER)
    assert isinstance(robot, Policy)
    action, _ = robot.act(OBSERVATION, robot.initial_state(3), None)
    np.testing.assert_allclose(action, [[0.25], [-0.5], [0.125]])


def test_what_it_remembers_belongs_to_its_own_episodes(load):
    robot = load(COUNTER)
    one, other = robot.initial_state(3), robot.initial_state(3)
    for _ in range(2):
        first, one = robot.act(OBSERVATION, one, None)
    second, other = robot.act(OBSERVATION, other, None)
    assert (first[0, 0], second[0, 0]) == (0.1, 0.0)


def test_it_cannot_be_turned_back(load):
    robot = load(COUNTER)
    start = robot.initial_state(3)
    robot.act(OBSERVATION, start, None)
    with pytest.raises(UserError, match=r"step 1: is at step 1, and cannot go back to 0"):
        robot.act(OBSERVATION, start, None)


def test_a_program_that_ended_is_started_again_but_not_in_the_middle_of_an_episode(load):
    robot = load(COUNTER)
    before = robot.initial_state(3)
    robot._model._open_session().kill()
    with pytest.raises(UserError, match="step 1: the program ended in the middle of this episode"):
        robot.act(OBSERVATION, before, None)
    action, _ = robot.act(OBSERVATION, robot.initial_state(3), None)
    np.testing.assert_array_equal(action, np.zeros((3, 1)))


def test_its_noise_comes_from_rigid(load):
    robot = load(NOISY)
    state = robot.initial_state(3)
    first, second = (
        robot.act(OBSERVATION / 2, state, np.random.default_rng(1))[0] for _ in range(2)
    )
    mean, _ = robot.act(OBSERVATION / 2, state, None)
    np.testing.assert_array_equal(first, second)
    np.testing.assert_allclose(mean[:, 0], OBSERVATION[:, 0] / 2)
    assert (first != mean).all()


def test_its_choices_become_scores(load):
    robot = load(CHOOSER, choices=(2,))
    action, _ = robot.act(OBSERVATION, robot.initial_state(3), None)
    np.testing.assert_array_equal(action, [[-1, 1], [1, -1], [-1, 1]])


def test_a_copy_in_another_process_starts_a_program_of_its_own(load):
    robot = load(DOUBLER)
    before = children()
    copy = pickle.loads(cloudpickle.dumps(robot))  # noqa: S301 - made on the line before.
    assert children() == before
    action, _ = copy.act(OBSERVATION, copy.initial_state(3), None)
    np.testing.assert_allclose(action, [[0.25], [-0.5], [0.125]])
    assert len(children() - before) == 1
    assert policy_hash(copy) == policy_hash(robot)


def test_a_program_that_was_changed_in_the_meantime_is_refused(load, tmp_path):
    robot = load(DOUBLER)
    copy = pickle.loads(cloudpickle.dumps(robot))  # noqa: S301 - made on the line before.
    write_program(tmp_path, DOUBLER.replace("/ 2", "/ 3"))
    with pytest.raises(UserError, match="serves something else than before: its files were chang"):
        copy.act(OBSERVATION, copy.initial_state(3), None)


def test_another_program_has_another_hash(load):
    assert policy_hash(load(DOUBLER)) != policy_hash(load(DOUBLER.replace("/ 2", "/ 3")))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param(serving("observation[:1, :1]"), "told (4, 1)", id="other-batch"),
        pytest.param(serving("1 / 0"), "ZeroDivisionError: division by zero", id="raises"),
        pytest.param(
            serving("np.random.randn(len(observation), 1)"), "in two ways", id="draws-its-own-noise"
        ),
        pytest.param(
            serving("observation[:, :1]").replace("size=2", "size=5"),
            "maps 5 observations to 1 actions", id="other-task",
        ),
        pytest.param(CHOOSER, "chooses among [2], but the robot of 'toy-reach' among reals",
                     id="choices-for-reals"),
    ],
)  # fmt: skip
def test_a_policy_that_does_not_fit_is_refused(load, text, message):
    with pytest.raises(UserError) as caught:
        load(text)
    assert str(caught.value).startswith("robot 'exec:")
    assert message in str(caught.value)


def test_a_task_is_no_policy(load):
    text = """
        import rigid_serve
        rigid_serve.serve_task(object, horizon=3, robot=(2, 1), human=(2, 1))
    """
    with pytest.raises(UserError, match="serves a task, which is not what it was named for"):
        load(text)


def test_an_action_that_is_no_number_is_refused_with_its_step(load):
    robot = load(serving("np.log(observation[:, :1])"))
    with pytest.raises(
        UserError, match=r"^robot 'exec:.* step 1: answers actions that are not fin"
    ):
        robot.act(OBSERVATION, robot.initial_state(3), None)


def test_a_program_that_ends_within_an_episode_is_told_of_with_its_step(load):
    robot = load(
        DOUBLER.replace("return obs", "observation[:, 0].max() < 9 or exit(4); return obs")
    )
    state = robot.initial_state(3)
    _, state = robot.act(OBSERVATION, state, None)
    with pytest.raises(UserError, match=r"step 2: the program ended \(exit code 4\)"):
        robot.act(OBSERVATION + 9, state, None)


def test_an_own_start_time_is_kept(tmp_path):
    command = write_program(tmp_path, "import time; time.sleep(60)")
    with pytest.raises(
        UserError, match=r"robot 'exec:x': the program did not answer within 0\.3 s"
    ):
        open_command(command, Wanted("exec:x", "robot", ToyReach()), seconds=0.3)
