"""Which numbers naturalness sees: the same ones while episodes are played and in stored ones."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.data.recording import record
from rigid.errors import UserError
from rigid.naturalness.features import choose_features, seen_through
from rigid.tasks.protocol import AgentSpec, BoundedTask
from tests.toys import Follower, Pointer, ToyReach

TASK = ToyReach()


class Silent(ToyReach):
    """Declares no features."""

    feature_names = ()

    def features(self, step):
        return step.features[:, :0]


@pytest.mark.parametrize(
    ("text", "label", "names"),
    [
        ("default", "default", ("hand", "goal")),
        ("goal,hand", "default", ("hand", "goal")),
        ("goal", "goal", ("goal",)),
        ("observation", "observation", ("robot", "hand", "goal")),
        ("observation+action", "observation+action", ("robot", "hand", "goal", "action_0")),
    ],
)
def test_choices_by_name(text, label, names):
    chosen = choose_features(text, TASK)
    assert (chosen.label, chosen.names) == (label, names)


def test_a_task_without_features_is_seen_by_observation_and_action():
    assert choose_features("default", Silent()).label == "observation+action"


def test_a_task_that_declares_observation_and_action_itself_is_asked_for_them():
    class Declaring(ToyReach):
        feature_names = ("robot", "hand", "goal", "action_0")

    assert choose_features("observation", Declaring()).columns == (0, 1, 2)
    assert choose_features("observation+action", Declaring()).columns == (0, 1, 2, 3)
    assert choose_features("observation", TASK).columns == (2, 3, 4)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "gaol",
            r"feature 'gaol' is unknown for task 'toy-reach', did you mean 'goal'\? features:",
        ),
        ("hand,hand", r"feature 'hand' is named twice: name each one once"),
    ],
)
def test_a_bad_choice_is_refused(text, message):
    with pytest.raises(UserError, match=message):
        choose_features(text, TASK)


def test_the_default_leaves_the_task_alone():
    assert seen_through(TASK, choose_features("default", TASK)) is TASK


def test_a_view_keeps_the_tasks_bounds_where_it_has_some():
    class Bounded(ToyReach):
        def bounds(self, agent):
            return np.array([[-1.0, 1.0]] * {"robot": 2, "human": 3}[agent])

    for task in (TASK, Bounded()):
        view = seen_through(task, choose_features("goal", task))
        assert isinstance(view, BoundedTask) == isinstance(task, BoundedTask)
    np.testing.assert_array_equal(view.bounds("human"), task.bounds("human"))


def test_a_view_keeps_the_tasks_pace_and_the_units_of_what_it_shows():
    task = ToyReach()
    task.control_period, task.feature_units = 0.5, {"hand": "m", "goal": "m"}
    view = seen_through(task, choose_features("goal", task))
    assert (view.control_period, view.feature_units) == (0.5, {"goal": "m"})


@pytest.mark.parametrize(
    ("text", "task"),
    [
        ("goal", TASK),
        ("observation", TASK),
        ("observation+action", TASK),
        ("observation", Silent()),
        ("observation+action", Silent()),
    ],
)
def test_playing_gives_what_stored_episodes_give(text, task):
    chosen = choose_features(text, task)
    players = {"robot": Follower(), "human": Pointer(noise=3.0)}  # Often beyond ±1.
    stored = record(task, **players, episodes=4, seed=0, batch=4, provenance={})
    played = record(
        seen_through(task, chosen), **players, episodes=4, seed=0, batch=4, provenance={}
    )
    taken = chosen.of(stored.features, stored.observations, stored.actions)
    np.testing.assert_array_equal(played.features, taken)
    assert played.feature_names == chosen.names


def test_of_a_discrete_action_the_choice_counts_and_never_its_scores():
    task = Silent()
    task.human = AgentSpec(1, 3, choices=(3,))
    chosen = choose_features("observation+action", task)
    scores = np.array([[2.0, 3.0, 0.1], [0.0, 0.2, 0.1]])
    seen = chosen.of(np.zeros((2, 0)), np.zeros((2, 1)), scores)
    np.testing.assert_array_equal(seen, [[0, -1, 1, -1]] * 2)


def test_actions_count_as_the_task_takes_them():
    chosen = choose_features("observation+action", TASK)
    nothing = np.zeros((1, 2)), np.zeros((1, 3))
    assert chosen.of(*nothing, np.array([[7.0]]))[0, -1] == 1
