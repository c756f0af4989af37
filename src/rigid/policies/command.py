"""Policies that live in a program of the user's: `exec:COMMAND`.

The program serves with `rigid_serve.serve_policy`. What it remembers stays on its side, so that it
can be any object; here an episode is only a number. RIGID says when it will not ask about one any
more. Every process of a measurement starts a program of its own, with its first question.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Shaped

from rigid.errors import UserError
from rigid.policies.foreign import ForeignPolicy, Wanted, open_model
from rigid.serving.child import Command
from rigid.serving.session import (
    START_SECONDS,
    Counts,
    PerProcess,
    Promise,
    Session,
    Size,
    opened_again,
)


class PolicyPromise(Promise):
    """What a program that serves a policy says of itself."""

    serves: Literal["policy"]
    observation_size: Size
    action_size: Size
    choices: Counts
    stateful: bool
    samples: bool


def open_command(text: str, wanted: Wanted, *, seconds: float = START_SECONDS) -> ForeignPolicy:
    """The policy that a program serves; it is started, and asked a few times.

    Args:
        text: The program and its arguments, quoted as for a shell.
        wanted: Whom it acts for.
        seconds: How long it may take to start.

    Raises:
        UserError: It cannot be started, ends, hangs, serves something else or no such actions.
    """
    command = Command(text, Path.cwd())
    try:
        session = Session(command, PolicyPromise, seconds=seconds)
    except UserError as error:
        raise UserError(f"{wanted.label}: {error}") from None
    promise, choices = session.promise, wanted.sizes.choices
    if promise.choices and promise.choices != choices:
        session.close()
        raise UserError(
            f"{wanted.label} chooses among {list(promise.choices)}, but the {wanted.agent} of "
            f"{wanted.task.name!r} among {list(choices) or 'reals'}: choose a policy of this task"
        )
    if promise.observation_size != wanted.sizes.observation_size:
        # The loader says so; a trial would only confuse it.
        session.close()
        return ForeignPolicy(
            CommandModel(session, command), wanted, promise.observation_size, promise.action_size
        )
    return open_model(CommandModel(session, command), wanted, promise.observation_size)


class _Episodes:
    """One set of episodes, which the program knows by its number."""

    def __init__(self, session: Session[PolicyPromise]) -> None:
        self.session, self.number, self.step = session, session.number(self), 0


class _Moment(NamedTuple):
    """Where a set of episodes stands."""

    episodes: _Episodes
    step: int


class CommandModel:
    """A program as a `rigid.policies.foreign.Model`."""

    def __init__(self, session: Session[PolicyPromise], command: Command) -> None:
        self._promise, self._command = session.promise, command
        self._session = PerProcess(session)

    def begin(self, batch: int) -> Any:
        """Names a set of episodes, if the program remembers any."""
        del batch
        if not self._promise.stateful:
            return ()
        return _Moment(_Episodes(self._open_session()), 0)

    def answer(
        self, observation: Float[np.ndarray, "B o"], memory: Any, rng: np.random.Generator | None
    ) -> tuple[Shaped[np.ndarray, "..."], Any]:
        """The program's answer.

        Raises:
            UserError: The program ended, hangs, or answers no action; or it has been asked for
                this step before and has gone on since, or has ended since the episode began.
        """
        seed = int(rng.integers(2**63)) if self._promise.samples and rng is not None else None
        if not isinstance(memory, _Moment):
            return self._ask(observation, {"seed": seed}), memory
        episodes, step = memory
        if episodes.session is not self._open_session():
            raise UserError(
                "the program ended in the middle of this episode, and another one knows nothing of "
                "it: begin the episode again"
            )
        if episodes.step != step:
            raise UserError(f"is at step {episodes.step}, and cannot go back to {step}")
        found = self._ask(observation, {"seed": seed, "episodes": episodes.number})
        episodes.step += 1
        return found, _Moment(episodes, episodes.step)

    def fingerprint(self) -> str:
        """SHA-256 over the command and what the program says of its files."""
        text = f"{self._command.text}\0{self._promise.fingerprint}"
        return hashlib.sha256(text.encode()).hexdigest()

    def _ask(
        self, observation: Float[np.ndarray, "B o"], fields: Mapping[str, Any]
    ) -> Shaped[np.ndarray, "..."]:
        session = self._open_session()
        session.send("act", fields, {"observation": observation.astype("<f4")})
        found = session.receive("action").arrays.get("action")
        if found is None:
            raise session.failure("answered without an action")
        return found

    def _open_session(self) -> Session[PolicyPromise]:
        """The running program; another one where it ended."""
        return self._session.get(self._open, broken=lambda session: session.broken)

    def _open(self) -> Session[PolicyPromise]:
        return opened_again(self._command, self._promise)
