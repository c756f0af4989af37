"""A robot whose referees are written by hand, and players whose hands stand where a test wants."""

from __future__ import annotations

from pathlib import Path

import jax.numpy as jnp
import numpy as np

from rigid.compute.pairs.members import MeasuredRun
from rigid.frontier.result import Frontier
from rigid.naturalness.features import choose_features
from rigid.naturalness.panel import Jury
from rigid.naturalness.rates import Rate
from rigid.naturalness.referee import Referee
from rigid.naturalness.standardise import Scale
from rigid.study.analysis.dominance import Frontage
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.records import Participant
from tests.frontier.samples import IDENTITY, data_of
from tests.study.toys import toy_arrays, toy_record
from tests.toys import ToyReach

TASK = ToyReach()
FRONT = Frontage(np.array([0.1, 0.9, 1.0]), np.array([0.9, 0.4, 0.1]), np.array([1.0, 0.6, 0.2]))


def panel(weights, alarm=0.0):
    """A referee that takes a step for an adversary's where `weights` times features is positive."""
    size = len(weights)
    layer = {"w": jnp.asarray(weights, jnp.float32)[:, None] * 100, "b": jnp.zeros(1)}
    scale = Scale(np.zeros(size, np.float32), np.eye(size, dtype=np.float32))
    return {"step": Jury((Referee([layer], scale),), {4.0: Rate(alarm, 0.0)})}


def robot(key="a", *, task=TASK, panels=None, heights=None, directory="run"):
    """A measured robot: one referee that suspects nobody, one that suspects hands above 0."""
    size = len(task.feature_names)
    lenient, strict = np.zeros(size), np.eye(size)[0]
    panels = panels or (panel(lenient), panel(strict))
    data = data_of(heights or {0: 0.4, 1: 0.5}, robot=f"robots/{key}", return_range=[-20.0, 0.0])
    run = MeasuredRun(Frontier(Path(directory), data), IDENTITY, task, key)
    return MeasuredRobot(
        key=key, runs=(run,), panels=tuple(panels),
        names=tuple(f"run/s{n}-r1-l1" for n in range(len(panels))), front=FRONT,
        features=choose_features("default", task),
    )  # fmt: skip


def episode(code="P01", number=0, *, hand=-0.5, harm=0.3, **changes):
    """An episode with the hand at one place and this adversarialness."""
    arrays = toy_arrays(TASK)
    arrays.features[:, 0] = hand
    fields = {"episode_return": -20.0 * harm, "arrays": arrays, "device": "mouse", **changes}
    return toy_record(TASK, code, number, **fields)


def person(code, kind="person", role="novice"):
    return Participant(
        code=code, kind=kind, role=role, external_id=None, status="done", consent_version="1",
        sharing=True, joined=None, demographics={}, calibration={},
    )  # fmt: skip


def everybody(records, scripted=()):
    """The participants of some episodes."""
    codes = dict.fromkeys(record.participant for record in records)
    return {code: person(code, "scripted" if code in scripted else "person") for code in codes}
