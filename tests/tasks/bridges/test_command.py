"""Tasks in programs of the user's: `exec:COMMAND`."""

import pickle

import cloudpickle
import numpy as np
import pytest

from rigid.compute.evaluation import evaluate
from rigid.errors import UserError
from rigid.naturalness.features import choose_features
from rigid.tasks.bridges.command import CommandTask
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task, task_from_description
from tests.serving.programs import REACH, children, write_program
from tests.toys import Follower, Pointer, ToyReach

RACE = """
    import numpy as np
    import rigid_serve

    class Race:
        def reset(self, seed):
            self.seed, self.place = seed, 0.0
            return [0.0], [float(seed)]

        def step(self, robot_action, human_action):
            assert self.place < 3, "was stepped after its end"
            self.place += 1
            see = [np.nan if self.seed == 13 else self.place], [float(self.seed)]
            info = {"success": self.place >= 2, "force": self.place, "note": "no number"}
            return (*see, -1.0, self.place == self.seed or self.place == 3, info)

    rigid_serve.serve_task(Race, horizon=4, robot=(1, 1), human=(1, 1), control_period=0.5)
"""
"""An episode of seed s ends after s steps, of three at most; each costs 1; seed 13 is broken."""

CHOOSE = """
    import rigid_serve

    class Choose:
        def reset(self, seed):
            return [0.0], [0.0]

        def step(self, robot_action, human_action):
            return [robot_action], [float(sum(human_action))], 0.0, False, {}

    rigid_serve.serve_task(
        Choose, horizon=1, robot=(1, 0), human=(1, 0), robot_choices=[3], human_choices=[2, 4]
    )
"""


COUNTED = """
    import rigid_serve

    class Counted:
        made = 0

        def __init__(self):
            Counted.made += 1

        def reset(self, seed):
            return [float(Counted.made)], [0.0]

        def step(self, robot_action, human_action):
            return [0.0], [0.0], 0.0, False, {}

    rigid_serve.serve_task(Counted, horizon=3, robot=(1, 1), human=(1, 1))
"""
"""The robot sees how many environments there are."""


@pytest.fixture
def task(tmp_path):
    """A task that a program serves, which ends with the test."""
    made = []

    def make(text, **options):
        made.append(CommandTask(write_program(tmp_path, text), **options))
        return made[-1]

    yield make
    for one in made:
        for session in one._sessions.get(list):
            session.close()


@pytest.fixture(scope="module")
def reach(tmp_path_factory):
    """`ToyReach` in programs."""
    folder = tmp_path_factory.mktemp("reach")
    task = make_task(f"exec:{write_program(folder, REACH)}")
    yield task
    for session in task._sessions.get(list):
        session.close()


def play(world, actions, seeds):
    world.reset(np.asarray(seeds))
    return [world.step(action, action) for action in actions]


class TestWorlds:
    def test_it_says_what_a_task_says(self, reach):
        toy = ToyReach()
        assert isinstance(reach, Task)
        for name in ("horizon", "feature_names", "return_range", "human"):
            assert getattr(reach, name) == getattr(toy, name)
        assert reach.describe()["name"] == reach.name
        assert task_from_description(reach.describe()) is None, "no file may start a program"

    def test_a_pair_fares_in_it_as_in_the_same_task_within_rigid(self, reach):
        found, expected = (
            evaluate(task, Follower(), Pointer(), episodes=7, seed=3)
            for task in (reach, ToyReach())
        )
        for name in ("success", "return", "return_std", "adversarialness", "episodes", "faults"):
            assert found[name] == pytest.approx(expected[name], abs=1e-6)

    def test_the_number_of_processes_changes_no_number(self, reach):
        actions = np.random.default_rng(0).uniform(-1, 1, (4, 5, 1))
        seeds = [5, 4, 3, 2, 1]
        alone, shared = (
            play(reach.make_world(5, threads=threads), actions, seeds) for threads in (1, 2)
        )
        for one, other in zip(alone, shared, strict=True):
            for mine, theirs in zip(one[:5], other[:5], strict=True):
                np.testing.assert_array_equal(mine, theirs)
            np.testing.assert_array_equal(one.info["distance"], other.info["distance"])

    def test_worlds_that_are_played_in_turn_do_not_meet(self, reach):
        actions = np.ones((3, 2, 1))
        one, other = (reach.make_world(2, threads=1) for _ in range(2))
        one.reset(np.array([1, 2]))
        play(other, -actions, [1, 2])
        step = one.step(actions[0], actions[0])
        np.testing.assert_allclose(step.features[:, 0], 0.2)

    def test_environments_of_worlds_that_are_gone_are_used_again_whoever_is_asked_next(self, task):
        made = task(COUNTED)
        kept = made.make_world(1, threads=1)
        kept.reset(np.array([0]))
        gone = made.make_world(1, threads=1)
        gone.reset(np.array([0]))
        del gone
        kept.step(np.zeros((1, 1)), np.zeros((1, 1)))  # Is told of it instead of a reset.
        step = made.make_world(2, threads=1).reset(np.array([0, 0]))
        # One in the check of the task, whose environment `kept` took over; then gone's, then a new.
        assert step.robot_observation.max() == 3

    def test_a_copy_in_another_process_starts_programs_of_its_own(self, reach):
        before = children()
        copy = pickle.loads(cloudpickle.dumps(reach))  # noqa: S301 - made on the line before.
        assert children() == before
        world = copy.make_world(1, threads=1)
        assert len(children() - before) == 1
        np.testing.assert_array_equal(
            world.reset(np.array([4])).human_observation,
            reach.make_world(1, threads=1).reset(np.array([4])).human_observation,
        )

    def test_discrete_actions_are_the_choices_of_the_largest_scores(self, task):
        choosing = task(CHOOSE)
        world = choosing.make_world(2, threads=1)
        assert (choosing.robot.action_size, choosing.human.action_size) == (3, 6)
        world.reset(np.array([0, 1]))
        step = world.step(
            np.array([[0.0, 0.2, 0.1], [-0.1, -0.2, -0.3]]),
            np.array([[0, 1, 0, 0, 0, 1], [1, 0, 0, 1, 0, 0]], dtype=float),
        )
        shown = [[0, -1, 1, -1, -1, -1, 1], [0, 1, -1, -1, 1, -1, -1]]  # After what it observed.
        np.testing.assert_array_equal(step.features, shown)
        np.testing.assert_array_equal(step.robot_observation, [[1], [0]])
        np.testing.assert_array_equal(step.human_observation, [[4], [1]])


class TestEndings:
    @pytest.fixture
    def race(self, task):
        world = task(RACE).make_world(3, threads=1)
        return play(world, np.zeros((4, 3, 1)), [1, 2, 13]), world.summary()

    def test_an_episode_that_ends_early_gains_and_loses_nothing_more(self, race):
        steps, summary = race
        returns = np.sum([step.reward for step in steps], axis=0)
        np.testing.assert_array_equal(returns[:2], [-1, -2])
        np.testing.assert_array_equal(summary.outcome[:2], [1, 1])
        np.testing.assert_array_equal(summary.extra["steps"][:2], [1, 2])

    def test_success_is_what_was_said_last(self, race):
        np.testing.assert_array_equal(race[1].success[:2], [0, 1])

    def test_forces_are_counted_while_the_episode_lasts(self, race):
        np.testing.assert_array_equal(race[1].peak_force[:2], [1, 2])
        np.testing.assert_array_equal(race[1].impulse[:2], [0.5, 1.5])

    def test_an_episode_whose_numbers_are_not_finite_is_a_fault(self, race):
        np.testing.assert_array_equal(race[0][-1].faulted, [False, False, True])
        assert np.isfinite(race[0][-1].robot_observation).all()

    def test_without_features_the_lived_steps_are_judged_by_what_was_seen_and_done(self, task):
        made = task(RACE.replace("[float(self.seed)]", "[self.place]"))
        assert made.feature_names == ("observation_0", "action_0")
        assert choose_features("observation+action", made).columns == (0, 1)
        world = made.make_world(1, threads=1)
        world.reset(np.array([2]))
        steps = [world.step(*np.full((2, 1, 1), action)) for action in (3.0, -0.5, 0.9, 0.9)]
        lived = [[2, 1], [1, -0.5]]  # Begins with its seed; the last two actions did nothing.
        np.testing.assert_array_equal([step.features[0] for step in steps], lived + lived)

    def test_what_is_never_measured_is_unknown(self, task):
        world = task(CHOOSE).make_world(1, threads=1)
        play(world, [np.zeros((1, 6))], [0])
        summary = world.summary()
        assert np.isnan([summary.success, summary.peak_force, summary.impulse]).all()


class TestRefusals:
    @pytest.mark.parametrize(
        ("change", "message"),
        [
            pytest.param(
                ("return [0.0], [float(seed)]", "return [np.random.rand()], [0.0]"),
                "begins two different episodes with the same seed", id="seed-ignored",
            ),
            pytest.param(
                ("return [0.0], [float(seed)]", "return [0.0, 1.0], [0.0]"),
                "answered robot_observation of shape (2,), but serve_task was told (1,)", id="size",
            ),
            pytest.param(
                ("return [0.0], [float(seed)]", "return [np.nan], [0.0]"),
                "begins with observations that are not finite", id="nan",
            ),
            pytest.param(("horizon=4", "horizon=0"), "said horizon: ", id="horizon"),
            pytest.param(
                ("horizon=4", "horizon=4, return_range=(0, -1)"), "with worst < best", id="range"
            ),
            pytest.param(
                ("horizon=4", "horizon=4, human_observation_names=('a', 'b')"),
                "there are 2 observation_names for 1 numbers", id="names",
            ),
        ],
    )  # fmt: skip
    def test_a_task_that_cannot_be_played_is_refused(self, task, change, message):
        assert change[0] in RACE
        with pytest.raises(UserError) as caught:
            task(RACE.replace(*change))
        assert str(caught.value).startswith("task 'exec:")
        assert message in str(caught.value)

    def test_a_success_that_is_neither_0_nor_1_is_refused(self, task):
        world = task(RACE.replace("self.place >= 2", "7")).make_world(1)
        world.reset(np.array([1]))
        with pytest.raises(UserError, match="answered success 7, but success is 1 or 0"):
            world.step(np.zeros((1, 1)), np.zeros((1, 1)))

    def test_features_that_are_not_told_are_missed(self, task):
        world = task(RACE.replace("horizon=4", "horizon=4, feature_names=['x']")).make_world(1)
        world.reset(np.array([1]))
        with pytest.raises(UserError, match="info has no 'features', but serve_task was told feat"):
            world.step(np.zeros((1, 1)), np.zeros((1, 1)))

    def test_a_program_that_ends_within_an_episode_is_told_of(self, task):
        made = task(RACE.replace("self.place += 1", "self.place += 1; self.seed < 9 or exit(5)"))
        world = made.make_world(2, threads=2)
        world.reset(np.array([1, 20]))
        with pytest.raises(UserError, match=r"ended \(exit code 5\) before it answered: mend the"):
            world.step(np.zeros((2, 1)), np.zeros((2, 1)))
        again = made.make_world(2, threads=2)  # New processes, since both are of no use any more.
        np.testing.assert_array_equal(again.reset(np.array([1, 2])).human_observation, [[1], [2]])

    def test_parameters_belong_into_the_command(self):
        with pytest.raises(UserError, match="takes no parameters, but was given human_agent"):
            make_task("exec:python3 x.py", human_agent="h")
