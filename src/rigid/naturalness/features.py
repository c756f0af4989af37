"""Which numbers naturalness sees of the human: `rigid frontier --features …`.

The choice holds for the search and for the referee alike. `default` is what the task declares, or,
where it declares nothing, the human's observation and action.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from rigid.errors import UserError
from rigid.policies.discrete import taken
from rigid.tasks.protocol import (
    AgentSpec,
    BoundedTask,
    LimitsWorlds,
    Step,
    Summary,
    Task,
    World,
    control_period,
    feature_units,
)

DEFAULT = "default"
OBSERVATION = "observation"
OBSERVATION_ACTION = "observation+action"


@dataclass(frozen=True)
class Features:
    """A choice of features, resolved for one task."""

    label: str
    """As it stands in `settings.json`: `default`, `observation`, `observation+action` or names."""
    names: tuple[str, ...]
    columns: tuple[int, ...]
    """Places among the task's own features, then the human's observation, then its action."""
    choices: tuple[int, ...] = ()
    """Of the human's discrete actions; see `AgentSpec.choices`."""

    def of(
        self,
        features: Float[np.ndarray, "*n f"],
        observation: Float[np.ndarray, "*n o"],
        action: Float[np.ndarray, "*n a"],
    ) -> Float[np.ndarray, "*n chosen"]:
        """The chosen numbers of each step.

        Args:
            features: The task's own, of the state that a step led to.
            observation: What the human saw before the step.
            action: What it did; seen as the task takes it: clipped to [-1, 1], or the choices.
        """
        acted = taken(action, AgentSpec(0, action.shape[-1], choices=self.choices))
        seen = np.concatenate([features, observation, acted], axis=-1, dtype=np.float32)
        return seen[..., list(self.columns)]


def choose_features(text: str, task: Task) -> Features:
    """The features that `text` names.

    Args:
        text: `default`, `observation`, `observation+action`, or some of `task.feature_names`
            separated by commas.
        task: Whose human is looked at.

    Raises:
        UserError: A name is unknown or given twice, or observations and actions are chosen of a
            task with `holds_after_end`: there they are held after an early end, and it has no
            features of them.
    """
    own = tuple(task.feature_names)
    observed = _named(task.human.observation_names, "observation", task.human.observation_size)
    done = _named((), "action", task.human.action_size)
    everything = own + observed + done
    if text == DEFAULT and own:
        return Features(DEFAULT, own, tuple(range(len(own))))
    # A task may declare them itself, since it knows better what they are where an episode is over.
    declared = own[: len(observed)] == observed and len(own) == len(observed + done)
    first = 0 if declared else len(own)
    if text == OBSERVATION:
        chosen = range(first, first + len(observed))
    elif text in {DEFAULT, OBSERVATION_ACTION}:
        text, chosen = OBSERVATION_ACTION, range(first, first + len(observed + done))
    else:
        return _by_name([name.strip() for name in text.split(",")], task)
    if getattr(task, "holds_after_end", False) and not declared:
        raise UserError(
            f"features {text!r} of task {task.name!r} cannot be judged: an episode that ends early "
            "is filled up, and what the human then observes and does is none of its motion: choose "
            f"among {', '.join(own) or 'features that the task should declare'}"
        )
    names = tuple(everything[place] for place in chosen)
    return Features(text, names, tuple(chosen), tuple(task.human.choices))


def _by_name(wanted: list[str], task: Task) -> Features:
    own = tuple(task.feature_names)
    for name in wanted:
        if name not in own:
            close = difflib.get_close_matches(name, own, n=1)
            suggestion = f", did you mean {close[0]!r}?" if close else ";"
            listed = ", ".join((DEFAULT, OBSERVATION, OBSERVATION_ACTION, *own))
            raise UserError(
                f"feature {name!r} is unknown for task {task.name!r}{suggestion} features: {listed}"
            )
        if wanted.count(name) > 1:
            raise UserError(f"feature {name!r} is named twice: name each one once")
    columns = tuple(sorted(own.index(name) for name in wanted))  # Their order changes nothing.
    names = tuple(own[place] for place in columns)
    return Features(DEFAULT if names == own else ",".join(names), names, columns)


def _named(names: tuple[str, ...], kind: str, count: int) -> tuple[str, ...]:
    return names or tuple(f"{kind}_{number}" for number in range(count))


def seen_through(task: Task, features: Features) -> Task:
    """The task with the chosen features in place of its own; the same object for the default."""
    return task if features.label == DEFAULT else _SeenTask(task, features)


class _SeenTask:
    """A task, but for its features."""

    def __init__(self, task: Task, features: Features) -> None:
        self._task, self._features = task, features
        self.name, self.horizon = task.name, task.horizon
        self.robot: AgentSpec = task.robot
        self.human: AgentSpec = task.human
        self.feature_names = features.names
        self.outcome_names = task.outcome_names
        self.return_range = task.return_range
        self.control_period = control_period(task)
        own = feature_units(task)
        self.feature_units = {name: own[name] for name in features.names if name in own}
        if isinstance(task, BoundedTask):
            self.bounds = task.bounds
        if isinstance(task, LimitsWorlds):
            self.most_worlds = task.most_worlds

    def make_world(self, batch: int, *, threads: int = 0) -> World:
        return _SeenWorld(self._task, self._features, batch, threads)

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        return step.features

    def scene(self) -> Mapping[str, Any] | None:
        return self._task.scene()

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        return self._task.replay(snapshots)

    def describe(self) -> Mapping[str, Any]:
        return self._task.describe()


class _SeenWorld:
    """Its worlds: a step carries what the human saw before it and what it did."""

    def __init__(self, task: Task, features: Features, batch: int, threads: int) -> None:
        self.batch, self._task, self._features = batch, task, features
        self._world = task.make_world(batch, threads=threads)
        self._seen = np.zeros((batch, task.human.observation_size), np.float32)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        return self._look(self._world.reset(seeds), np.zeros((self.batch, self._actions)))

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        return self._look(self._world.step(robot_action, human_action), human_action)

    def summary(self) -> Summary:
        return self._world.summary()

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        return self._world.snapshot()

    @property
    def _actions(self) -> int:
        return self._task.human.action_size

    def _look(self, step: Step, action: np.ndarray) -> Step:
        seen, self._seen = self._seen, step.human_observation.copy()
        chosen = self._features.of(self._task.features(step), seen, action)
        return step._replace(features=chosen)
