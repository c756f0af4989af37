"""A pilot: a study played through by scripts on a real server, and what is checked afterwards."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from rigid.cli import run
from rigid.commands.study.piloting import table
from rigid.errors import UserError
from rigid.study.judging.answers import _passed
from rigid.study.judging.questions import SCALES, SIDES
from rigid.study.judging.trials import Trial
from rigid.study.pilot.checking import check_participant, plays_again
from rigid.study.pilot.run import PilotOrder, run_pilot
from rigid.study.pilot.scripted import random_answers, reference_side
from rigid.study.pilot.server import pilot_server
from rigid.study.plan import PlayStage, Role, load_plan
from rigid.study.players import open_players
from rigid.study.service.messages import Responses, read_message
from rigid.study.store import Store
from rigid.study.store.schema import FILE

STUDY = """\
title: A tiny study
robots: {a: "builtin:vanilla"}
roles:
  novice:
    participants: 3
    stages:
      - {kind: practise, episodes: 1}
      - {kind: play, episodes: 1}
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.yaml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def order(study):
    data = study.parent / "pilot"
    return PilotOrder(study=str(study), data=data, scripts=("follow",), participants=1, speed=20.0)


@pytest.fixture(scope="module")
def pilot(order):
    """What is found after a pilot, and how far its bar came."""
    done = []
    found = run_pilot(order, lambda ahead: (done.append(-ahead.things), lambda: done.append(1))[1])
    return found, sum(done)


@pytest.fixture
def store(pilot, order):
    del pilot  # Only its data matters.
    with Store.read(order.data) as store:
        yield store


def test_a_script_takes_part_from_the_consent_to_the_last_page(pilot):
    (found,) = pilot[0]
    assert found.problems == ()
    assert (found.practised, found.played, found.script) == (1, 1, "follow")
    assert found.participant.status == "done"
    assert set(found.participant.demographics) > {"age", "handedness"}


def test_what_a_pilot_leaves_is_called_scripted(store):
    assert [person.kind for person in store.participants()] == ["scripted"]
    assert {episode.device for episode in store.episodes()} == {"scripted"}


def test_the_bar_of_a_pilot_ends_full(pilot):
    assert pilot[1] == 0


def test_targets_that_a_script_sends_are_those_that_are_used(store):
    (practised, _) = store.episodes()
    assert np.isfinite(practised.arrays.target_age).mean() > 0.9


@pytest.mark.usefixtures("pilot")
def test_a_pilot_is_refused_where_a_study_is(order):
    with pytest.raises(UserError, match="holds a study already: choose a directory of its"):
        run_pilot(order, lambda _: lambda: None)


def test_episodes_that_are_missing_are_told(study, store):
    plan = load_plan(study)
    stages = (*plan.roles["novice"].stages, PlayStage(episodes=2))
    more = plan.model_copy(update={"roles": {"novice": Role(participants=1, stages=stages)}})
    players = open_players(plan, trust=False)
    (who,) = store.participants()
    found = check_participant(more, players, store, who.code, "the server is gone")
    assert found.problems == (
        "the server is gone", "has 1 episodes of play with robot a, not 3",
    )  # fmt: skip


def test_an_episode_that_was_changed_does_not_come_out_again(study, store):
    task, robots = open_players(load_plan(study), trust=False)
    record = next(store.episodes())
    assert plays_again(task, robots["a"], record)
    changed = record.arrays.human_actions.copy()
    changed[50] = -changed[50]
    other = replace(record, arrays=replace(record.arrays, human_actions=changed))
    assert not plays_again(task, robots["a"], other)


def test_the_table_has_a_line_for_each(pilot):
    head, line = table(pilot[0]).splitlines()
    assert head.split()[:3] == ["code", "role", "script"]
    assert line.split()[:5] == [pilot[0][0].participant.code, "novice", "follow", "1", "1"]


def answers(question, itself):
    return random_answers(question, itself, np.random.default_rng(0))


def test_a_scripted_rater_answers_every_question_within_its_scale():
    said = answers("danger", None)
    assert set(said) == {"goal-left", "goal-right", "danger-left", "danger-right"}
    assert all(0 <= value <= 7 for value in said.values())


def test_whole_numbers_of_a_scale_stay_whole_on_their_way():
    said = {"stage": 1, "trial": "t00", "responses": {"goal-left": 4}, "rt": 2}
    heard = read_message(Responses, json.dumps(said))
    assert isinstance(heard.responses["goal-left"], int)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("question", ["correspondence", "danger", "naturalness"])
def test_a_scripted_rater_passes_every_attention_check(question, side, judging):
    check = judging(question, reference_on=side)
    given = answers(question, reference_side(check))
    values = {
        (scale, check.member(at)): given[f"{scale}-{at}"]
        for scale in SCALES.get(question, ())
        for at in SIDES
    }
    assert _passed(check, values or {("correspondence", "both"): float(given[question] == side)})


@pytest.fixture
def judging():
    """Makes an attention check of a question."""

    def check(question, *, reference_on):
        left = "second" if reference_on == "left" else "first"
        return Trial(
            id="t03", position=3, of=8, question=question, pair=None, shown_left=left,
            clips={}, keys={},
        )  # fmt: skip

    return check


def test_a_server_that_cannot_start_says_why(tmp_path):
    serving = pilot_server("builtin:paper", tmp_path / "data", speed=1.0, trust=False)
    with pytest.raises(UserError, match="study 'builtin:paper' is unknown"), serving:
        pass


def test_a_pilot_that_cannot_begin_leaves_no_study_behind(tmp_path):
    study = tmp_path / "study.yaml"
    judge = "{kind: judge, question: danger, pairs: none.json, show: snapshot, count: 1}"
    study.write_text(
        f'title: A study\nrobots: {{a: "builtin:vanilla"}}\nroles:\n  rater:\n    participants: 1\n'
        f"    stages: [{judge}]\n"
    )
    order = PilotOrder(study=str(study), data=tmp_path / "pilot", scripts=("still",))
    with pytest.raises(UserError, match=r"none\.json does not exist"):
        run_pilot(order, lambda _: lambda: None)
    assert not (order.data / FILE).exists()


@pytest.mark.parametrize("served", [True, False], ids=["that is served", "that was served"])
def test_a_pilot_spares_a_study_that_somebody_made_in_the_meantime(
    study, tmp_path, monkeypatch, served
):
    """The first look finds nothing; the pilot's own server finds the study."""
    data = tmp_path / "data"
    other = Store.open(data, load_plan(str(study)))
    code = other.invite("novice").code
    if not served:
        other.close()
    monkeypatch.setattr("rigid.study.pilot.run.refuse_study", lambda _: None)
    order = PilotOrder(study=str(study), data=data, scripts=("still",))
    why = "another process serves" if served else "holds a study already"
    with pytest.raises(UserError, match=why):
        run_pilot(order, lambda _: lambda: None)
    other.close()
    with Store.read(data) as store:
        assert store.participant(code).status == "invited"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--scripts", "extend,dance"], "script 'dance' is unknown: choose one of extend, retreat"),
        (["--participants", "0"], "--participants is 0, but must be at least 1"),
        (["--speed", "0"], "--speed 0 must be between 0.1 and 100"),
    ],
)
def test_what_no_pilot_can_be_is_refused(words, message, tmp_path, capsys):
    given = ["--study", "builtin:paper-exhaustiveness", "--data", str(tmp_path / "d"), *words]
    assert run(["study", "pilot", *given]) == 2
    assert message in capsys.readouterr().err


def test_robots_that_run_code_need_trust():
    plan = load_plan("builtin:paper-exhaustiveness")
    plan = plan.model_copy(update={"robots": {"a": "python:my_code:make"}})
    with pytest.raises(UserError, match="would run code that a file names"):
        open_players(plan, trust=False)


def test_tasks_that_run_code_need_trust():
    plan = load_plan("builtin:paper-exhaustiveness")
    plan = plan.model_copy(update={"task": "pettingzoo:my_code:make"})
    with pytest.raises(
        UserError, match="runs code: say --trust if you trust whoever wrote the study"
    ):
        open_players(plan, trust=False)
