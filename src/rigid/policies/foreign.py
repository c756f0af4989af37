"""Policies of other libraries: whatever they answer is checked before the task sees it."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int, Shaped

from rigid.errors import UserError
from rigid.policies.discrete import actions_of
from rigid.policies.native import Agent
from rigid.tasks.protocol import AgentSpec, Task

_LONGEST = 300  # Characters of an error of another library. Ours.
_TRIALS = 4  # Worlds of the trial at opening. Ours.
_TOLERANCE = 1e-3
"""Answers to equal observations that differ by more are no mean actions: batches of another order
add up in another order, which is worth 1e-6. Ours."""


@runtime_checkable
class Model(Protocol):
    """What stands behind a `ForeignPolicy`: a session, a network, somebody's object."""

    def begin(self, batch: int) -> Any:
        """What it remembers before the first step."""
        ...

    def answer(
        self, observation: Float[np.ndarray, "B o"], memory: Any, rng: np.random.Generator | None
    ) -> tuple[Shaped[np.ndarray, "..."], Any]:
        """Its answer, reals or whole numbers, and what it remembers then."""
        ...

    def fingerprint(self) -> str:
        """SHA-256 over all that decides how it acts."""
        ...


@dataclass(frozen=True)
class Wanted:
    """What a user asked for, and what it has to fit."""

    spec: str
    """As the user wrote it."""
    agent: Agent
    task: Task

    @property
    def label(self) -> str:
        """Begins every message."""
        return f"{self.agent} {self.spec!r}"

    @property
    def sizes(self) -> AgentSpec:
        """What the agent sees and does."""
        return self.task.robot if self.agent == "robot" else self.task.human


class ForeignState(NamedTuple):
    """What a `ForeignPolicy` carries from step to step."""

    steps: Int[np.ndarray, " B"]
    """Steps done; for messages."""
    memory: Any


class ForeignPolicy:
    """A model of another library as a `Policy`; its actions are checked, in every step."""

    def __init__(
        self, model: Model, wanted: Wanted, observation_size: int, action_size: int
    ) -> None:
        self.observation_size, self.action_size = observation_size, action_size
        self._model, self._label, self._sizes = model, wanted.label, wanted.sizes

    def initial_state(self, batch: int) -> ForeignState:
        """The state before the first step."""
        try:
            return ForeignState(np.zeros(batch, np.int64), _begin(self._model, batch))
        except UserError as error:
            raise UserError(f"{self._label}: {error}") from None

    def act(
        self,
        observation: Float[np.ndarray, "B o"],
        state: ForeignState,
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], ForeignState]:
        """Actions in [-1, 1]; most models know no noise, and then `rng` changes nothing.

        Raises:
            UserError: The model fails, or answers something that is no action of the task.
        """
        try:
            answer, memory = _ask(self._model, observation, state.memory, rng)
            action = actions_of(answer, self._sizes, len(observation))
        except (ValueError, UserError) as error:
            raise UserError(f"{self._label}, step {state.steps[0] + 1}: {error}") from None
        return action, ForeignState(state.steps + 1, memory)

    def fingerprint(self) -> str:
        """SHA-256 over all that decides how it acts."""
        return self._model.fingerprint()


def check_made_for(wanted: Wanted, agent: str, trained_for: object) -> None:
    """Refuses the policy of another agent or task.

    Raises:
        UserError: It is.
    """
    if agent != wanted.agent:
        raise UserError(f"{wanted.label} is a policy of the {agent}: choose a {wanted.agent}'s")
    if trained_for != wanted.task.name:
        raise UserError(
            f"{wanted.label} was trained for task {trained_for!r}, not {wanted.task.name!r}: "
            "choose a policy of this task"
        )


def need_packages(wanted: Wanted, extra: str, *modules: str) -> None:
    """Says what to install where a library is missing.

    Raises:
        UserError: One of `modules` cannot be imported.
    """
    for module in modules:
        if find_spec(module) is None:
            raise UserError(f"{wanted.label} needs {module}: pip install 'rigid-frontier[{extra}]'")


def first_line(error: Exception) -> str:
    """Kind and message of another library's error, short enough for a message of ours."""
    text = str(error).strip().partition("\n")[0][:_LONGEST]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _begin(model: Model, batch: int) -> Any:
    """What a model remembers before the first step; whatever it raises becomes a `UserError`."""
    try:
        return model.begin(batch)
    except UserError:
        raise
    except Exception as error:  # noqa: BLE001 - Models of anybody's making may raise anything.
        raise UserError(f"cannot begin an episode ({first_line(error)})") from None


def _ask(
    model: Model,
    observation: Float[np.ndarray, "B o"],
    memory: Any,
    rng: np.random.Generator | None,
) -> tuple[Shaped[np.ndarray, "..."], Any]:
    """A model's answer to a copy of the observation, which it may write on; errors as `_begin`."""
    try:
        answer, after = model.answer(np.array(observation, np.float32), memory, rng)
        return np.asarray(answer), after
    except UserError:
        raise
    except Exception as error:  # noqa: BLE001 - Models of anybody's making may raise anything.
        raise UserError(f"cannot answer ({first_line(error)})") from None


def open_model(model: Model, wanted: Wanted, observation_size: int | None) -> ForeignPolicy:
    """A policy of a model that can be asked at any time; it is, to learn what it answers.

    Args:
        model: What acts.
        wanted: What it was asked for.
        observation_size: Numbers that it sees; None where nothing says so but the task.

    Raises:
        UserError: It cannot be asked, it gives random answers or no actions, or its answer to one
            world depends on the others.
    """
    sees = observation_size or wanted.sizes.observation_size
    try:
        shown_zeros = np.zeros((_TRIALS, sees), np.float32)
        answer, _ = _ask(model, shown_zeros, _begin(model, _TRIALS), None)
        does = _action_size(answer, wanted.sizes)
    except (ValueError, UserError) as error:
        shown = "" if observation_size else f" (shown {sees} numbers, as the {wanted.agent} sees)"
        raise UserError(f"{wanted.label}: {error}{shown}") from None
    policy = ForeignPolicy(model, wanted, sees, does)
    if (sees, does) == (wanted.sizes.observation_size, wanted.sizes.action_size):
        _check_rows(model, wanted, sees)
    return policy


def _action_size(answer: Shaped[np.ndarray, "..."], sizes: AgentSpec) -> int:
    """What a trial says of a model's actions; refuses what can be no action of the task."""
    if answer.dtype.kind in "biu" or answer.ndim != 2 or len(answer) != _TRIALS:
        actions_of(answer, sizes, _TRIALS)  # Says what is wrong, if anything.
        return sizes.action_size
    return int(answer.shape[1])


def _check_rows(model: Model, wanted: Wanted, sees: int) -> None:
    """Equal observations get equal answers, in every world and every time."""
    # A fixed seed: what is refused once is refused always.
    observation = np.random.default_rng(0).standard_normal((_TRIALS, sees)).astype(np.float32)
    once, again = (_two_steps(model, observation, wanted) for _ in range(2))
    if not np.allclose(once, again, atol=_TOLERANCE, rtol=_TOLERANCE, equal_nan=True):
        raise UserError(
            f"{wanted.label} answers the same observations in two ways: export its mean action, "
            "with what it remembers as inputs and outputs, none of it inside"
        )
    others = -observation
    others[-1] = observation[0]  # The same world in another row, among others.
    moved = _two_steps(model, others, wanted)[-1]
    if not np.allclose(once[0], moved, atol=_TOLERANCE, rtol=_TOLERANCE, equal_nan=True):
        raise UserError(
            f"{wanted.label} answers differently in another row of the batch: its worlds must not "
            "depend on each other"
        )


def _two_steps(
    model: Model, observation: Float[np.ndarray, "B o"], wanted: Wanted
) -> Shaped[np.ndarray, "B ..."]:
    """Answers in the second step of an episode, so that memory takes part."""
    try:
        memory = _begin(model, len(observation))
        _, memory = _ask(model, observation, memory, None)
        return _ask(model, observation, memory, None)[0]
    except UserError as error:
        raise UserError(f"{wanted.label}: {error}") from None
