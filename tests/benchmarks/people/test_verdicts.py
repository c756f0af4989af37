"""When the service is said to hold."""

import pytest
import yaml

from benchmarks.people.hostile import held
from benchmarks.people.load import holds, study_file
from benchmarks.people.server import COMMAND
from rigid.study.plan import load_plan

LOAD = {"period_ms": {"p95": 104.0}, "lost": 0, "whole": True, "resumed_wrongly": []}
HOSTILE = {
    "alive": True, "tracebacks": 0, "accepted": {"path_trick": 0}, "counted": 9, "messages": 9,
    "lost": 0, "touched": [], "episodes_of_attackers": 0, "withdrawn": 0,
    "other": {"broken_off": 0, "refused": {}, "episodes": 1},
}  # fmt: skip


@pytest.mark.parametrize(
    "change",
    [
        {"period_ms": None}, {"period_ms": {"p95": 120.0}}, {"lost": 1}, {"whole": False},
        {"resumed_wrongly": ["play: 1 of 2"]},
    ],
)  # fmt: skip
def test_a_load_that_anything_was_lost_in_does_not_hold(change):
    assert holds(LOAD)
    assert not holds(LOAD | change)


@pytest.mark.parametrize(
    "change",
    [
        {"alive": False}, {"tracebacks": 1}, {"accepted": {"path_trick": 1}}, {"counted": 8},
        {"lost": 1}, {"touched": ["P02"]}, {"episodes_of_attackers": 1}, {"withdrawn": 1},
        {"other": HOSTILE["other"] | {"broken_off": 1}},
        {"other": HOSTILE["other"] | {"refused": {"not-now": 1}}},
        {"other": HOSTILE["other"] | {"episodes": 0}},
    ],
)  # fmt: skip
def test_an_attack_that_had_any_effect_does_not_hold(change):
    assert held(HOSTILE)
    assert not held(HOSTILE | change)


def test_the_study_of_a_load_lasts_as_long_as_the_load(tmp_path):
    path = tmp_path / "study.yaml"
    path.write_text(study_file(30, 180.0))
    stages = load_plan(path).roles["novice"].stages
    assert 10 * stages[-1].episodes >= 180
    assert yaml.safe_load(path.read_text())["roles"]["novice"]["participants"] == 30


def test_the_server_is_started_by_the_users_own_command():
    assert COMMAND[1:] == ("-m", "rigid", "study", "serve")
