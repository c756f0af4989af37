"""Players who follow a script: for pilots and tests, always called scripted, never people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.policies.loading import load_policy
from rigid.study.play.again import states_with
from rigid.study.play.episode import LOADING, PlayedEpisode

SPEED = 0.25
"""Of targets that move to somewhere [m/s]. Ours: upwards the arm goes no faster."""
AHEAD = 3
"""Control steps by which a followed path runs ahead. Ours: as many as a fast hand lags behind."""
TREMBLE = 0.06
"""How far the trembling target goes to either side [m]. Ours: the hand then shakes by 2 cm; going
to the other side in every step instead, at 5 Hz, it shakes by half a centimetre."""


@runtime_checkable
class Script(Protocol):
    """Moves the target of one player; make a new one for each episode."""

    def target(
        self, step: int, hand: Float[np.ndarray, "3"], episode: PlayedEpisode
    ) -> Float[np.ndarray, "3"]:
        """Where the target is in control step `step`, counted from 0 [m], world frame.

        Args:
            step: About to be played.
            hand: Where the hand is [m].
            episode: What is played.
        """
        ...


class _Placed:
    """A script that goes by where the hand was at the start."""

    def __init__(self) -> None:
        self._start = np.zeros(3)

    def target(
        self, step: int, hand: Float[np.ndarray, "3"], episode: PlayedEpisode
    ) -> Float[np.ndarray, "3"]:
        """See `Script.target`."""
        if step == 0:
            self._start = np.array(hand)
        return self._at(step, episode)

    def _at(self, step: int, episode: PlayedEpisode) -> Float[np.ndarray, "3"]:
        """Still: stays at the start."""
        del step, episode
        return self._start

    def _going(self, goal: np.ndarray, step: int, period: float) -> Float[np.ndarray, "3"]:
        """On the way from the start to `goal`, at `SPEED`."""
        away = goal - self._start
        far = float(np.linalg.norm(away))
        share = min((step + 1) * period * SPEED / far, 1.0) if far > 0 else 1.0
        return np.asarray(self._start + share * away)


class _Extend(_Placed):
    """Stretches out, away from the shoulder."""

    def _at(self, step: int, episode: PlayedEpisode) -> Float[np.ndarray, "3"]:
        centre, radius = episode.handle.reach
        out = (self._start - centre) / np.linalg.norm(self._start - centre)
        return self._going(centre + radius * out, step, episode.period)


class _Retreat(_Placed):
    """Draws back to the shoulder."""

    def _at(self, step: int, episode: PlayedEpisode) -> Float[np.ndarray, "3"]:
        return self._going(episode.handle.reach.centre, step, episode.period)


class _Tremble(_Placed):
    """Shakes up and down about the start, to the other side after every two steps: 2.5 Hz."""

    def _at(self, step: int, episode: PlayedEpisode) -> Float[np.ndarray, "3"]:
        del episode
        return self._start + (TREMBLE if step % 4 > 1 else -TREMBLE) * np.array([0.0, 0.0, 1.0])


class _Follow:
    """Moves the hand as the task's synthetic human does from the same start, by its mean action.

    Only the hand: where it was a moment later is the target, whatever the rest of the arm did.
    """

    def __init__(self) -> None:
        self._path = np.zeros((1, 3))

    def target(
        self, step: int, hand: Float[np.ndarray, "3"], episode: PlayedEpisode
    ) -> Float[np.ndarray, "3"]:
        """See `Script.target`; slow at step 0, where it first lets the synthetic human play."""
        del hand
        if step == 0:
            with LOADING:
                human = load_policy("builtin:synthetic-human", task=episode.task, agent="human")
            states = states_with(episode.task, episode.robot, human, seed=episode.seed)
            self._path = np.array([episode.handle.place(state) for state in states])
        return np.asarray(self._path[min(step + AHEAD, len(self._path) - 1)])


_SCRIPTS: Mapping[str, type[Script]] = {
    "extend": _Extend,
    "retreat": _Retreat,
    "tremble": _Tremble,
    "still": _Placed,
    "follow": _Follow,
}
SCRIPT_NAMES = tuple(_SCRIPTS)


def script(name: str) -> Script:
    """A script for one episode.

    Raises:
        UserError: There is none of this name.
    """
    if name not in _SCRIPTS:
        raise UserError(f"script {name!r} is unknown: choose one of {', '.join(_SCRIPTS)}")
    return _SCRIPTS[name]()
