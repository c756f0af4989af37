"""The worlds of a task that a program serves, shared out among its processes.

What ends early is filled up here (`padding`): a program steps only what is not over.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from rigid.policies.discrete import taken
from rigid.serving.session import Session
from rigid.tasks.bridges.command_promise import PlayerPromise, TaskPromise
from rigid.tasks.bridges.padding import Moment, Padding
from rigid.tasks.protocol import Step, Summary

_INFO = "info "
"""Begins the names of the arrays that hold measurements."""


class _Share(NamedTuple):
    """The worlds that one process holds."""

    session: Session[TaskPromise]
    number: int
    """By which it knows them."""
    rows: slice


class CommandWorld:
    """B environments, shared out among processes of a program."""

    def __init__(
        self, promise: TaskPromise, batch: int, sessions: Sequence[Session[TaskPromise]]
    ) -> None:
        self.batch, self._promise = batch, promise
        ends = np.linspace(0, batch, len(sessions) + 1).astype(int)
        self._shares = [
            _Share(session, session.number(self), slice(*pair))
            for session, pair in zip(sessions, pairwise(ends), strict=True)
        ]
        self._padding: Padding | None = None
        self._info: Mapping[str, np.ndarray] = {}
        self._peak = self._impulse = np.full(batch, np.nan)
        self._seen = np.zeros((batch, promise.human.observation_size), np.float32)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world."""
        self._info, self._peak, self._impulse = {}, *np.full((2, self.batch), np.nan)
        moment = self._ask("reset", {"seeds": np.asarray(seeds, np.int64)}, self._shares)
        self._seen = moment.human_observation
        moment = self._looked_at(moment, np.zeros((self.batch, self._promise.human.action_size)))
        self._padding = Padding(self._promise.horizon, moment)
        return self._padding.first()

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        """Advances the worlds that are not over."""
        assert self._padding is not None
        running = self._padding.running
        arrays = {
            "robot_action": _as_given(robot_action, self._promise.robot),
            "human_action": _as_given(human_action, self._promise.human),
            "running": running,
        }
        asked = [share for share in self._shares if running[share.rows].any()]
        done = taken(human_action, self._promise.human.spec())
        moment = self._looked_at(self._ask("step", arrays, asked), done)
        step = self._padding.after(moment)
        self._info, self._seen = step.info, step.human_observation.copy()
        if "force" in moment.info:
            self._feel(np.where(running & ~step.faulted, moment.info["force"], np.nan))
        return step

    def summary(self) -> Summary:
        """Success is what the program said last of an episode; what it never says is NaN.

        `extra` has `steps`, those that the environment itself had.
        """
        assert self._padding is not None
        success = self._info.get("success", np.full(self.batch, np.nan))
        outcome = self._padding.ended_early.astype(np.int64)
        extra = {"steps": self._padding.lived.astype(np.float64)}
        return Summary(success.copy(), outcome, self._peak, self._impulse, extra)

    def snapshot(self) -> Float[np.ndarray, "B 0"]:
        """Nothing to show."""
        return np.zeros((self.batch, 0))

    def _looked_at(self, moment: Moment, done: Float[np.ndarray, "B a_h"]) -> Moment:
        """With what the human saw before the step and did, where the program has no features."""
        if self._promise.feature_names:
            return moment
        seen_and_done = np.hstack([self._seen, done]).astype(np.float32)
        return moment._replace(features=seen_and_done)

    def _feel(self, force: Float[np.ndarray, " B"]) -> None:
        """Counts the force of a step; NaN is none."""
        self._peak = np.fmax(self._peak, force)
        pushed = force * self._promise.control_period
        self._impulse = np.where(
            np.isnan(pushed), self._impulse, np.nan_to_num(self._impulse) + pushed
        )

    def _ask(self, kind: str, arrays: Mapping[str, np.ndarray], asked: Sequence[_Share]) -> Moment:
        """All processes at once; the worlds of those that are not asked say nothing."""
        try:
            for share in asked:
                rows = {name: values[share.rows] for name, values in arrays.items()}
                share.session.send(kind, {"worlds": share.number}, rows)
            answers = [(share.rows, _answered(share)) for share in asked]
        except BaseException:  # What the others answer would be taken for that to their next call.
            for share in asked:
                share.session.kill()
            raise
        return _moment(self._promise, self.batch, answers, self._info)


def _answered(share: _Share) -> dict[str, np.ndarray]:
    """What one process answered, in the shapes that it promised."""
    session, worlds = share.session, share.rows.stop - share.rows.start
    arrays, promise = session.receive("moment").arrays, session.promise
    wanted = {
        "robot_observation": (worlds, promise.robot.observation_size),
        "human_observation": (worlds, promise.human.observation_size),
        "reward": (worlds,),
        "features": (worlds, len(promise.feature_names)),
        "ended": (worlds,),
        **{name: (worlds,) for name in arrays if name.startswith(_INFO)},
    }
    for name, shape in wanted.items():
        found = arrays[name].shape if name in arrays else None
        if found != shape:
            raise session.failure(f"answered {name} of shape {found}, but promised {shape}")
    success = arrays.get(f"{_INFO}success", np.zeros(0))
    strange = success[~np.isnan(success) & ~np.isin(success, (0, 1))]
    if len(strange):
        raise session.failure(f"answered success {strange[0]:g}, but success is 1 or 0")
    return {name: arrays[name] for name in wanted}


def _moment(
    promise: TaskPromise,
    batch: int,
    answers: Sequence[tuple[slice, Mapping[str, np.ndarray]]],
    measured: Iterable[str],
) -> Moment:
    """What all worlds said; a measurement that one of them did not make this time is NaN there.

    Args:
        promise: Says the sizes.
        batch: B.
        answers: Of each process that was asked, with its worlds.
        measured: What was measured before: it keeps its place, since a world that is over holds it.
    """
    moment = Moment(
        np.zeros((batch, promise.robot.observation_size), np.float32),
        np.zeros((batch, promise.human.observation_size), np.float32),
        np.zeros(batch),
        np.zeros((batch, len(promise.feature_names)), np.float32),
        np.zeros(batch, bool),
        info={},
    )
    info = {name: np.full(batch, np.nan) for name in measured}
    for rows, answer in answers:
        for name, values in answer.items():
            if name.startswith(_INFO):
                place = info.setdefault(name.removeprefix(_INFO), np.full(batch, np.nan))
            else:
                place = getattr(moment, name)
            place[rows] = values
    return moment._replace(info=info)


def _as_given(action: Float[np.ndarray, "B a"], player: PlayerPromise) -> np.ndarray:
    """Clipped reals, or the choices of the largest scores."""
    if not player.choices:
        return np.asarray(np.clip(action, -1.0, 1.0), np.float64)
    blocks = np.split(action, np.cumsum(player.choices)[:-1], axis=1)
    chosen: np.ndarray = np.stack([block.argmax(axis=1) for block in blocks], axis=1)
    return chosen.astype(np.int64)
