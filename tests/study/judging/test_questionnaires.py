"""The three questionnaires in a real browser, from a real server: what is meant is stored."""

from __future__ import annotations

import pytest

from rigid.report.build import embed_json
from rigid.study.judging import prepare_clips, trials_for
from rigid.study.plan import JudgeStage, Role, StudyPlan
from rigid.study.service.opening import front_end, texts_of
from tests.study.judging.sources import ROBOT, TASK
from tests.study.page.conftest import browser, visit  # noqa: F401 - Fixtures.
from tests.study.service.serving import served

CALM = {"reduced_motion": "reduce"}
"""Motions wait to be played: nothing here needs them to."""
LOSES = """
const reach = window.fetch;
window.lost = 0;
window.fetch = (...what) =>
  window.lost-- > 0 ? Promise.reject(new TypeError("gone")) : reach(...what);
"""


def stage(files, question, **changes):
    fields = {"question": question, "pairs": files[question], "count": 1, "show": "replay"}
    return JudgeStage(**fields | changes)


@pytest.fixture(scope="module")
def rater(pair_files, tmp_path_factory):
    """Makes raters of a study who have consented."""
    snapshot = stage(pair_files, "correspondence", show="snapshot", count=2, attention_checks=1)
    others = (stage(pair_files, "danger"), stage(pair_files, "naturalness"))
    plan = StudyPlan(
        title="Judging", robots={"a": "elsewhere"}, demographics=False,
        roles={"rater": Role(participants=4, stages=(snapshot, *others))},
    )  # fmt: skip
    data = tmp_path_factory.mktemp("judging") / "data"
    with served(data, plan, task=TASK) as found:
        service = found.service
        service.clips = prepare_clips(plan, data, task=TASK, robots={"a": ROBOT})
        service.static, service.texts = front_end(), texts_of("en")
        service.scene = embed_json(TASK.scene()).encode()

        class Rater:
            def __init__(self):
                page = found.page("rater")
                self.code, self.url = page.code, page.url

            def trials(self, number):
                return trials_for(plan, number, service.store.participant(self.code))

            def answers(self, number=None):
                """(trial, question, of) → (response, passed)."""
                return {
                    (one.trial, one.question, one.of): (one.response, one.passed)
                    for one in service.store.answers(self.code)
                    if number in (None, one.stage)
                }

        yield Rater


def heading(page, text):
    page.wait_for_function("text => document.querySelector('h1')?.textContent === text", arg=text)


def begin(page, title):
    """By keyboard, from the heading, where the page puts it."""
    heading(page, title)
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")


def asked(page, number, of):
    heading(page, f"Question {number} of {of}")
    page.wait_for_selector(".judge form")


def type_keys(page, keys):
    for key in (*keys, "Enter"):
        page.keyboard.press(key)


@pytest.mark.slow
def test_a_rater_answers_all_three_by_keyboard_alone(rater, visit):  # noqa: F811 - The fixture.
    someone = rater()
    with visit(someone, **CALM) as page:
        begin(page, "Which one is closer to the reference?")
        for number, key in enumerate("aba"):
            asked(page, number + 1, 3)
            type_keys(page, key)
        begin(page, "How well, and how dangerous?")
        asked(page, 1, 1)
        type_keys(page, "0725")
        begin(page, "How close to the reference?")
        asked(page, 1, 1)
        type_keys(page, "61")
        page.wait_for_selector("body[data-screen=done]")
    chosen = {}
    for trial, side in zip(someone.trials(0), ("left", "right", "left"), strict=True):
        second = float(trial.member(side) == "second")
        passed = None if trial.pair is not None else second == 1
        chosen[trial.id, "correspondence", "both"] = (second, passed)
    assert someone.answers(0) == chosen
    (danger,), (natural,) = someone.trials(1), someone.trials(2)
    left, right = danger.member("left"), danger.member("right")
    assert someone.answers(1) == {
        ("t00", "goal", left): (0, None), ("t00", "goal", right): (7, None),
        ("t00", "danger", left): (2, None), ("t00", "danger", right): (5, None),
    }  # fmt: skip
    assert someone.answers(2) == {
        ("t00", "naturalness", natural.member("left")): (6, None),
        ("t00", "naturalness", natural.member("right")): (1, None),
    }


@pytest.mark.slow
def test_a_reload_goes_on_at_the_question_without_an_answer(rater, visit):  # noqa: F811 - Ditto.
    someone = rater()
    with visit(someone, **CALM) as page:
        page.click(".judge-intro .primary")
        asked(page, 1, 3)
        page.get_by_label("Picture B").check()
        page.click("text=Next")
        asked(page, 2, 3)
        page.reload()
        page.wait_for_selector("text=2 of 3 questions are left.")
        page.click(".judge-intro .primary")
        asked(page, 2, 3)
    assert [trial for trial, _, _ in someone.answers()] == ["t00"]


@pytest.mark.slow
def test_nothing_is_sent_before_everything_is_answered(rater, visit):  # noqa: F811 - Ditto.
    someone = rater()
    with visit(someone, **CALM) as page:
        page.click(".judge-intro .primary")
        asked(page, 1, 3)
        page.click("text=Next")
        page.wait_for_selector("text=Please choose one")
        assert page.evaluate("document.activeElement.value") == "left"
        page.keyboard.press("Space")
        assert page.locator(".missing").is_hidden()
    assert someone.answers() == {}


def test_an_answer_waits_out_a_lost_connection_and_counts_once(rater, visit):  # noqa: F811 - Ditto.
    someone = rater()
    with visit(someone, LOSES, **CALM) as page:
        page.click(".judge-intro .primary")
        asked(page, 1, 3)
        page.evaluate("window.lost = 2")
        type_keys(page, "b")
        page.wait_for_selector(".offline:visible")
        assert page.locator("h1").inner_text() == "Question 1 of 3"
        asked(page, 2, 3)
    assert len(someone.answers()) == 1


@pytest.mark.slow
def test_playing_moves_what_plays_and_leaves_the_stills(rater, visit):  # noqa: F811 - Ditto.
    with visit(rater(), **CALM) as page:
        page.click(".judge-intro .primary")
        asked(page, 1, 3)
        pictures = "[...document.querySelectorAll('.judge canvas')].map(c => c.toDataURL())"
        page.wait_for_timeout(200)
        before = page.evaluate(pictures)
        page.evaluate(
            """() => {
                const slider = document.querySelector('.judge input[type=range]');
                slider.value = slider.max;
                slider.dispatchEvent(new Event('input'));
            }"""
        )
        page.wait_for_function(f"before => ({pictures})[0] !== before", arg=before[0])
        assert page.evaluate(pictures)[1:] == before[1:]
