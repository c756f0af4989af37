"""Episodes that end early, filled up to the task's horizon so that ending gains nobody anything.

RIGID's episodes all have the same length. Environments of others end when they like, and whoever
profits from what comes after the end learns to bring it about (Kostrikov et al., 2019, on GAIL).
After its last step a world therefore stays as it is:

* Reward is 0, so that the return is the environment's own, whatever the sign of its rewards.
* Both players' observations are held. Their actions do nothing any more.
* Features are *the episode's own*: those of the steps that were lived, each about equally often.
  Naturalness and its penalty are means over all steps of an episode, so that an episode is judged
  as if it had gone on as it was.

Why none of the usual ways. Steps of weight 0 escape the penalty λ·D of all the steps that are left:
a human who cannot move naturally would end the episode. Held features let it end in a natural pose
and be judged by that pose from there on. An absorbing state with a flag tells the referee how the
episode ended, which is often the robot's doing: a robot that falls over when a person moves quite
naturally would then seem to have met an unnatural person, and its worst failures would be missed.

Two limits. Moments of the beginning weigh more in short episodes, so that an episode of less than a
quarter (1/κ) of the usual length may look unnatural for that alone; this errs towards naturalness
too low. And windows of steps that reach beyond the end see the motion slower or faster than it was;
the x axis is about single steps.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from rigid.tasks.protocol import Step


class Moment(NamedTuple):
    """What B environments said after a reset or a step.

    Rows of worlds that had ended before may hold anything. A number that is not finite is a fault:
    its world weighs nothing from then on, as when physics runs away.
    """

    robot_observation: Float[np.ndarray, "B robot"]
    human_observation: Float[np.ndarray, "B human"]
    reward: Float[np.ndarray, " B"]
    """0 after a reset."""
    features: Float[np.ndarray, "B features"]
    """Of this step; the world repeats them after the end."""
    ended: Bool[np.ndarray, " B"]
    """Whether this was the last step: terminated, truncated, or an agent has left."""
    info: Mapping[str, Shaped[np.ndarray, " B"]]
    """The same names at every step."""


class Padding:
    """Keeps B worlds of one set of episodes at their horizon; begin anew with a new one.

    Example:
        >>> def moment(reward, x, ended):
        ...     one = np.array([[x]])
        ...     return Moment(one, one, np.array([reward]), one, np.array([ended]), {})
        >>> padding = Padding(horizon=4, first=moment(0.0, 0.0, ended=False))
        >>> steps = [padding.after(moment(1.0, 5.0, ended=False))]
        >>> steps.append(padding.after(moment(1.0, 6.0, ended=True)))
        >>> steps += [padding.after(moment(1.0, np.nan, ended=False)) for _ in range(2)]
        >>> [(step.reward.item(), step.features.item()) for step in steps]
        [(1.0, 5.0), (1.0, 6.0), (0.0, 5.0), (0.0, 6.0)]
    """

    def __init__(self, horizon: int, first: Moment) -> None:
        """Begins the episodes.

        Args:
            horizon: Steps of an episode, T.
            first: What the worlds said after the reset.
        """
        self.horizon = horizon
        batch = len(first.reward)
        self._time = 0
        self._lived: Int[np.ndarray, " B"] = np.full(batch, horizon)
        self._faulted = np.zeros(batch, dtype=bool)
        self._past: list[np.ndarray] = []  # Features of each step, [B, f].
        nothing = first._replace(
            robot_observation=np.zeros_like(first.robot_observation, np.float32),
            human_observation=np.zeros_like(first.human_observation, np.float32),
            features=np.zeros_like(first.features, np.float32),
        )
        self._held = self._merge(nothing, first, np.ones(batch, dtype=bool))
        self._note_endings(first)

    @property
    def running(self) -> Bool[np.ndarray, " B"]:
        """The worlds that are to be stepped: neither over nor faulted."""
        return np.asarray((self._lived > self._time) & ~self._faulted)

    @property
    def lived(self) -> Int[np.ndarray, " B"]:
        """Steps that each episode has had of its own, as far as it has come."""
        return np.asarray(np.minimum(self._lived, self._time))

    @property
    def ended_early(self) -> Bool[np.ndarray, " B"]:
        """Episodes that were over before the horizon."""
        return np.asarray(self._lived < self.horizon)

    def first(self) -> Step:
        """The step after the reset."""
        assert self._time == 0
        return self._step(np.zeros(len(self._lived)), self._held.features)

    def after(self, moment: Moment) -> Step:
        """The next step of every world.

        Args:
            moment: What the running worlds said; other rows are not looked at.
        """
        running = self.running
        self._time += 1
        self._held = self._merge(self._held, moment, running)
        running &= ~self._faulted  # A fault of this very step counts for nothing.
        self._note_endings(moment._replace(ended=moment.ended & running))
        features = np.where(running[:, None], self._held.features, self._repeated())
        self._past.append(features.astype(np.float32))
        return self._step(np.where(running, moment.reward, 0.0), self._past[-1])

    def _merge(self, old: Moment, new: Moment, running: np.ndarray) -> Moment:
        """The worlds' numbers: new ones where a world runs and they are sound, else old ones."""
        columns = (new.robot_observation, new.human_observation, new.features, new.reward[:, None])
        finite = np.logical_and.reduce([np.isfinite(column).all(axis=1) for column in columns])
        self._faulted |= running & ~finite
        taken = running & finite

        def merged(before: np.ndarray, after: np.ndarray) -> np.ndarray:
            return np.where(taken[:, None], after, before).astype(np.float32)

        return new._replace(
            robot_observation=merged(old.robot_observation, new.robot_observation),
            human_observation=merged(old.human_observation, new.human_observation),
            features=merged(old.features, new.features),
            info={
                name: np.where(taken, values, old.info.get(name, values))
                for name, values in new.info.items()
            },
        )

    def _note_endings(self, moment: Moment) -> None:
        self._lived = np.where(moment.ended, self._time, self._lived)

    def _repeated(self) -> Float[np.ndarray, "B f"]:
        """Features of a lived step: the k-th of n missing ones shows the (k+½)/n-th part of life.

        So every lived step comes up equally often, up to one, and none is favoured by its place.
        """
        worlds = np.flatnonzero((self._lived < self._time) & (self._lived > 0))
        features = self._held.features.copy()
        if len(worlds):
            lived = self._lived[worlds]
            share = (self._time - lived - 0.5) / (self.horizon - lived)
            moments = np.minimum((share * lived).astype(int), lived - 1)
            for row, time in zip(worlds, moments, strict=True):
                features[row] = self._past[time][row]
        return features

    def _step(self, reward: np.ndarray, features: np.ndarray) -> Step:
        held = self._held
        return Step(
            held.robot_observation.copy(), held.human_observation.copy(), reward,
            features.copy(), self._faulted.copy(), dict(held.info),
        )  # fmt: skip
