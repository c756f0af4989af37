"""Examinations of toy tasks, each of which lacks one thing."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from rigid.compute.doctor import curve as doctor_curve
from rigid.compute.doctor import domain as doctor
from rigid.compute.doctor.domain import DOCTOR, check_doctor_place, doctor_preset, examine
from rigid.compute.subject import Subject
from rigid.data.episodes import save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.native import load_native
from rigid.tasks.analytic.hand_tracking import HandTracking
from tests.compute.tiny import TINY, FilmedReach, Notes
from tests.toys import ToyReach, ToyWorld

MANY = replace(TINY, search_canonical=40)
"""As many canonical episodes as the paper's."""


class WithConstant(FilmedReach):
    """The toy task with a feature that never moves."""

    feature_names = ("hand", "goal", "temperature")

    def make_world(self, batch, *, threads=0):
        del threads
        return _ConstantWorld(self, batch)


class _ConstantWorld(ToyWorld):
    def _look(self, reward):
        step = super()._look(reward)
        constant = np.full((self.batch, 1), 36.6, np.float32)
        return step._replace(features=np.concatenate([step.features, constant], axis=1))


class Deaf(FilmedReach):
    """The toy task with a reward that is the start's alone, whatever anybody does."""

    def make_world(self, batch, *, threads=0):
        del threads
        return _DeafWorld(self, batch)


class _DeafWorld(ToyWorld):
    def step(self, robot_action, human_action):
        return super().step(robot_action, human_action)._replace(reward=self._goal.copy())


@pytest.fixture
def quick(monkeypatch):
    """A learning curve of few judges, each of few gradient steps."""
    hasty = RefereeSettings(hidden=(16,), learning_rate=1e-2, block=50, blocks=6)
    monkeypatch.setattr(doctor_curve, "_SETTINGS", hasty)
    monkeypatch.setattr(doctor_curve, "REPETITIONS", 1)
    monkeypatch.setattr(doctor_curve, "SIZES", (3, 25))


@pytest.fixture
def examined(base, tmp_path):
    """Verdicts on a task with the toy pair, by step."""
    robot, human = (str(base / "pair" / agent) for agent in ("robot", "human"))

    def of(task, **options):
        subject = Subject(task, robot, human, **options)
        found = examine(subject, MANY, out=tmp_path, listener=Notes())
        return {verdict.step: verdict for verdict in found.verdicts}

    return of


def statuses(found):
    return {step: verdict.status for step, verdict in found.items()}


@pytest.mark.usefixtures("quick")
def test_a_constant_feature_fails_by_its_name(examined):
    found = examined(WithConstant())
    by_status = statuses(found)
    assert [step for step, status in by_status.items() if status == "fail"] == ["features"]
    assert [by_status[step] for step in ("reward", "ends", "scan")] == ["skip"] * 3
    assert "temperature" in found["features"].says


@pytest.mark.usefixtures("quick")
def test_leaving_the_constant_feature_out_is_the_cure(examined, monkeypatch):
    monkeypatch.setattr(doctor, "measure_robot", interrupted)
    with pytest.raises(KeyboardInterrupt):  # Nothing before the search fails.
        examined(WithConstant(), features="hand,goal")


def interrupted(*_, **__):
    raise KeyboardInterrupt


@pytest.mark.usefixtures("quick")
def test_a_reward_that_no_human_can_influence_fails(examined):
    found = examined(Deaf())
    assert found["reward"].status == "fail"
    assert "The human has no influence on the reward" in found["reward"].says
    assert [step for step, verdict in found.items() if verdict.status == "fail"] == ["reward"]


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("source", ["synthetic", "recorded"])
def test_three_canonical_episodes_fail(source, base, examined, tmp_path_factory):
    pair = (load_native(base / "pair" / agent).policy for agent in ("robot", "human"))
    episodes = record(ToyReach(), *pair, episodes=3, seed=0, provenance={})
    path = tmp_path_factory.mktemp("canonical") / "three.npz"
    save_episodes(path, replace(episodes, source=source))
    found = examined(FilmedReach(), canonical=str(path))
    assert [step for step, verdict in found.items() if verdict.status == "fail"] == ["data"]
    assert "3 canonical episodes" in found["data"].says
    assert "would be enough" in found["data"].advice or "at least 12" in found["data"].advice


@pytest.mark.usefixtures("quick")
def test_what_was_found_lies_in_doctor_json(examined, tmp_path):
    found = examined(Deaf())
    stored = json.loads((tmp_path / "doctor.json").read_text())
    assert stored["passed"] is False
    assert [verdict["step"] for verdict in stored["verdicts"]] == list(found)
    assert stored["verdicts"][2]["evidence"]["returns"]["passive"]["episodes"] == 60


def test_a_directory_of_something_else_is_refused(tmp_path):
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(UserError, match=r"holds thesis\.tex, which no examination made"):
        check_doctor_place(tmp_path)


def test_short_episodes_are_played_more_often():
    assert doctor_preset(HandTracking()).episodes == 60
    assert doctor_preset(ToyReach(horizon=1000)).episodes == DOCTOR.episodes


@pytest.mark.parametrize("count", [12, 13, 40])
def test_every_use_of_the_fewest_episodes_has_some(count):
    pool = doctor_curve.divide(np.zeros((count, 2, 1)))
    assert min(map(len, pool)) >= 3
    assert sum(map(len, pool)) == count


@pytest.mark.usefixtures("quick")
def test_more_canonical_episodes_make_better_judges():
    rng = np.random.default_rng(0)
    # A pose of each episode's own, which all features tell: three episodes show three of them.
    poses = rng.standard_normal((160, 1, 1))
    motion = (poses + 0.1 * rng.standard_normal((160, 10, 4))).astype(np.float32)
    pool = doctor_curve.Pool(motion[:60], motion[60:110], motion[110:])
    curve = doctor_curve.learning_curve(pool, strangers=motion)
    assert np.mean(curve[60]) > np.mean(curve[3]) + 0.02
    assert list(curve) == [3, 25, 60]


@pytest.mark.slow
def test_a_healthy_task_passes(tmp_path):
    task = HandTracking()
    found = examine(
        Subject(task, "builtin:tracker"), doctor_preset(task), out=tmp_path, listener=Notes()
    )
    assert not found.failed
    assert "skip" not in {verdict.status for verdict in found.verdicts}
