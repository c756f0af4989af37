"""Settings of the adversary in place of the preset's."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from rigid.compute.measurement import measure_robot
from rigid.compute.preparation import settings_for
from rigid.compute.subject import Subject
from rigid.errors import UserError
from tests.compute.tiny import TINY, FilmedReach, hasten_referees, store_pair

PRESET = replace(TINY, seeds=(0,), per_round=(2,))


def changed(preset):
    settings = settings_for(preset, search_measure="mmd")
    return replace(settings, ppo=replace(settings.ppo, learning_rate=0.002))


@pytest.fixture
def subject(tmp_path, monkeypatch):
    hasten_referees(monkeypatch)
    store_pair(tmp_path)
    return Subject(FilmedReach(), str(tmp_path / "robot"), str(tmp_path / "human"))


def test_settings_of_another_budget_than_the_preset_are_refused(tmp_path, subject):
    settings = changed(replace(PRESET, iterations=7))
    with pytest.raises(ValueError, match="train for 7 iterations of 4 episodes, but preset 'tiny'"):
        measure_robot(subject, PRESET, out=tmp_path / "run", settings=settings)
    assert not (tmp_path / "run").exists()


def test_settings_are_part_of_the_identity_of_a_run(tmp_path, subject):
    out = tmp_path / "run"
    run = measure_robot(subject, PRESET, out=out, lambdas=(1.0,), settings=changed(PRESET))
    identity = json.loads((out / "settings.json").read_text())["identity"]
    assert identity["adversary"]["ppo"]["learning_rate"] == 0.002
    assert run.data["search_measure"] == identity["measure"] == "mmd"
    with pytest.raises(UserError, match=r"adversary\.ppo\.learning_rate is 0.002 there"):
        measure_robot(subject, PRESET, out=out, lambdas=(1.0,), search_measure="mmd")
