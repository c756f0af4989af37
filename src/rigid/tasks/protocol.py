"""The two-player world: what a task offers to learning, naturalness and report.

A task is a two-player, fixed-horizon Dec-POMDP with agents `robot` and `human` and one shared
reward (paper, section 3). Everything is batched: B denotes the number of worlds, and every array
has it as its leading axis. Every episode of a task has the same length, so that no agent can gain
by ending early.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.policies.protocol import Policy


@dataclass(frozen=True)
class AgentSpec:
    """What one agent sees and does; actions are reals in [-1, 1].

    A discrete action of n choices is n reals, one score a choice, of which the task takes the
    largest: so a Gaussian policy learns it as it learns any other.
    """

    observation_size: int
    action_size: int
    observation_names: tuple[str, ...] = ()
    """A name for each observed number, in order; empty when the task declares none."""
    choices: tuple[int, ...] = ()
    """Numbers of choices of the discrete actions side by side; empty where actions are reals."""


class Step(NamedTuple):
    """The worlds after a reset or a control step."""

    robot_observation: Float[np.ndarray, "B robot"]
    human_observation: Float[np.ndarray, "B human"]
    reward: Float[np.ndarray, " B"]
    """Shared reward of this step; 0 after a reset."""
    features: Float[np.ndarray, "B features"]
    """What naturalness sees of the human (design: never robot state, never contact)."""
    faulted: Bool[np.ndarray, " B"]
    """Worlds whose physics ran away in this episode; they weigh nothing from then on."""
    info: Mapping[str, np.ndarray]
    """Named reward terms and measurements, each [B]."""


class Summary(NamedTuple):
    """How the episodes ended, each array [B]."""

    success: Float[np.ndarray, " B"]
    """1 or 0 by the task's own criterion; NaN where it defines none."""
    outcome: Int[np.ndarray, " B"]
    """Index into `Task.outcome_names`."""
    peak_force: Float[np.ndarray, " B"]
    """Largest force of the robot on the person [N]; NaN where the task knows no forces."""
    impulse: Float[np.ndarray, " B"]
    """Force of the robot on the person, integrated over the episode [N s]; NaN likewise."""
    extra: Mapping[str, np.ndarray]
    """Whatever else the task counts."""


@runtime_checkable
class World(Protocol):
    """B episodes that run side by side; the only stateful part of a task."""

    batch: int

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world; the same seed gives the same start in any world."""
        ...

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        """Advances every world by one control step; actions are clipped to [-1, 1]."""
        ...

    def summary(self) -> Summary:
        """How the current episodes stand; final after `Task.horizon` steps."""
        ...

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        """Whatever `Task.replay` needs to show this moment; no columns when it shows nothing."""
        ...


@runtime_checkable
class KeepsMotion(Protocol):
    """A world that can tell how its joints moved within a control step; optional."""

    def keep_motion(self) -> None:
        """Records the motion from now on; off at first, so that training does not pay for it.

        Nothing else that the world does changes.
        """
        ...

    def motion(self) -> Float[np.ndarray, "B S nq"]:
        """Joint angles [rad] after each of the S physics steps of the last control step.

        S is 1 after a reset, and until the first step that is recorded: the angles as they are.
        Of a world that ran away in the step: S times its start.

        Raises:
            ValueError: `keep_motion` was not called.
        """
        ...


@runtime_checkable
class Task(Protocol):
    """A two-player task; build worlds with `make_world`."""

    name: str
    horizon: int
    robot: AgentSpec
    human: AgentSpec
    feature_names: tuple[str, ...]
    outcome_names: tuple[str, ...]
    return_range: tuple[float, float] | None
    """Returns (worst, best) that map to adversarialness 1 and 0; frozen per task version."""

    def make_world(self, batch: int, *, threads: int = 0) -> World:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        ...

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        """What naturalness sees of the human."""
        ...

    def scene(self) -> Mapping[str, Any] | None:
        """Shapes to draw, as the report wants them; None for a task without a picture."""
        ...

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Poses (frames, bodies, 7), forces and contacts of one episode, for the report."""
        ...

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON: two tasks are equal when these are."""
        ...


@runtime_checkable
class BringsPolicies(Protocol):
    """A task whose `builtin:NAME` policies are made in memory, such as exact ones; optional."""

    def builtin_policies(self, agent: Literal["robot", "human"]) -> Mapping[str, Policy]:
        """Policies of `agent` by name."""
        ...


@runtime_checkable
class Paced(Protocol):
    """A task that says how long a control step takes; optional."""

    control_period: float
    """[s]."""


@runtime_checkable
class NamesUnits(Protocol):
    """A task that says what its features are measured in; optional."""

    feature_units: Mapping[str, str]
    """By the feature's name, such as rad or m/s; features without a unit are left out."""


@runtime_checkable
class LimitsWorlds(Protocol):
    """A task whose worlds are too heavy for hundreds of them; optional."""

    most_worlds: int
    """At a time, where episodes are only played; training has as many as its episodes."""


@runtime_checkable
class BoundedTask(Task, Protocol):
    """A task that says how large what its agents see can get; optional."""

    def bounds(self, agent: str) -> Float[np.ndarray, "n 2"]:
        """Finite (low, high) of each number that `agent` observes."""
        ...


@runtime_checkable
class VariesHumans(Protocol):
    """A task that shows the robot how the human moves, and whose humans can vary; optional."""

    shown_human: tuple[str, ...]
    """Those of the robot's observations that show the human: places, which differ as it moves."""

    def diversified(self) -> Task:
        """The same task, in which what the human wants varies as much as it can."""
        ...


@runtime_checkable
class DrawsFeatures(Protocol):
    """A task that can draw the human as its features describe it; optional."""

    def human_poses(
        self, names: Sequence[str], features: Float[np.ndarray, "n f"]
    ) -> Mapping[str, Any] | None:
        """The human's moving `bodies`, indices into the scene's, and their `poses` (n, bodies, 7).

        Args:
            names: Of the features, which may be others than the task's own.
            features: A row for each moment.

        Returns:
            None where these features do not tell the pose.
        """
        ...


def control_period(task: Task) -> float:
    """How long a control step of a task takes [s]; 0.1 where it says nothing, as in the paper."""
    return task.control_period if isinstance(task, Paced) else 0.1


def feature_units(task: Task) -> Mapping[str, str]:
    """What a task's features are measured in, by their names; empty where it says nothing."""
    return task.feature_units if isinstance(task, NamesUnits) else {}


def adversarialness(
    returns: Float[np.ndarray, " n"], return_range: Sequence[float]
) -> Float[np.ndarray, " n"]:
    """Negative return mapped to [0, 1] by the task's frozen range, clipped per episode.

    Paper, appendix 'Plotting in the Natural-Adversarial Coordinate'; clipping before the mean is
    ours, since a mean of clipped values cannot be moved by one extreme episode.

    Args:
        returns: Undiscounted episode returns, shape (n,).
        return_range: The returns (worst, best) that map to 1 and 0.

    Raises:
        ValueError: `return_range` is not increasing.

    Example:
        >>> adversarialness(np.array([-100.0, -40.0, 50.0]), (-100.0, 20.0))
        array([1. , 0.5, 0. ])
    """
    worst, best = return_range
    if not worst < best:
        raise ValueError(
            f"return_range must be (worst, best) with worst < best, got {return_range}"
        )
    return np.clip((best - np.asarray(returns)) / (best - worst), 0.0, 1.0)
