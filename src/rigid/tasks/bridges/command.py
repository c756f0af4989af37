"""Tasks that live in a program of the user's: `exec:COMMAND`.

The program serves with `rigid_serve.serve_task`. Worlds are shared out among as many processes of
it as there are threads.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.cores import cores
from rigid.errors import UserError
from rigid.serving.child import Command
from rigid.serving.session import START_SECONDS, PerProcess, Session, opened_again
from rigid.tasks.bridges.command_promise import TaskPromise
from rigid.tasks.bridges.command_world import CommandWorld
from rigid.tasks.bridges.task import MOST_WORLDS, OUTCOMES
from rigid.tasks.protocol import Step

_SAME_START = 1e-3
"""Observations after two resets with one seed that differ by more are another start: physics that
is begun again may differ in its last digits. Ours."""


class CommandTask:
    """A two-player task that a program serves."""

    outcome_names: tuple[str, ...] = OUTCOMES
    most_worlds = MOST_WORLDS
    holds_after_end = True
    """See `rigid.naturalness.features.choose_features`."""

    def __init__(self, text: str, *, seconds: float = START_SECONDS) -> None:
        """Starts the program and begins an episode twice.

        Args:
            text: The program and its arguments, quoted as for a shell.
            seconds: How long it may take to start.

        Raises:
            UserError: It cannot be started, ends, hangs, or serves something else; or the same
                seed begins different episodes.
        """
        self.name = f"exec:{text}"
        self._command = Command(text, Path.cwd(), f"task {self.name!r}")
        session = Session(self._command, TaskPromise, seconds=seconds)
        promise = self._promise = session.promise
        self._sessions = PerProcess([session])
        self.horizon = promise.horizon
        self.robot, self.human = promise.robot.spec(), promise.human.spec()
        self.feature_names, self.feature_units = promise.seen_names, promise.feature_units
        self.return_range, self.control_period = promise.return_range, promise.control_period
        _check_starts(session)

    def make_world(self, batch: int, *, threads: int = 0) -> CommandWorld:
        """Returns `batch` worlds in `threads` processes of the program (0: one for every core).

        Processes serve all worlds of this task, and end with it, or with RIGID.
        """
        sessions = self._sessions.get(list)
        sessions[:] = [session for session in sessions if not session.broken]
        count = min(threads or len(cores()), batch)
        while len(sessions) < count:
            sessions.append(opened_again(self._command, self._promise))
        return CommandWorld(self._promise, batch, sessions[:count])

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        """What the program says that naturalness sees; else what the human saw and then did."""
        return step.features

    def scene(self) -> None:
        """Nothing to draw."""

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Nothing to show."""
        del snapshots
        return {}

    def describe(self) -> Mapping[str, Any]:
        """The command, and the fingerprint of its files: another version is another task."""
        version = self._promise.fingerprint
        return {"name": self.name, "version": version, "parameters": {}}


def _check_starts(session: Session[TaskPromise]) -> None:
    """Begins the episode of seed 0 twice.

    Raises:
        UserError: What the players see differs, or is not finite.
    """
    world = CommandWorld(session.promise, 1, [session])
    steps = [world.reset(np.zeros(1, np.int64)) for _ in range(2)]
    if steps[0].faulted.any():
        raise session.failure("begins with observations that are not finite", "mend its reset")
    starts = [np.hstack([step.robot_observation, step.human_observation]) for step in steps]
    if not np.allclose(starts[0], starts[1], atol=_SAME_START, rtol=_SAME_START):
        raise session.failure(
            "begins two different episodes with the same seed",
            "its reset(seed) has to draw everything random from `seed`",
        )


def open_command_task(text: str, parameters: Mapping[str, Any]) -> CommandTask:
    """The task `exec:TEXT`.

    Raises:
        UserError: It takes no parameters, and what `CommandTask` raises.
    """
    if parameters:
        raise UserError(
            f"exec:{text} takes no parameters, but was given {', '.join(parameters)}: write them "
            "into the command"
        )
    return CommandTask(text)
