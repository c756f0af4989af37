"""The page of a study in a browser: no script runs, whatever the study's words are."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rigid.study.analysis.judgements import judge
from rigid.study.analysis.page import study_page
from rigid.study.analysis.reading import StudyData
from rigid.study.analysis.settings import AnalysisSettings
from rigid.study.analysis.whole import analyse
from rigid.study.plan import WatchStage
from tests.study.analysis.planted import episode, everybody, robot
from tests.study.analysis.scripted_answers import halves
from tests.study.toys import toy_plan

HOSTILE = '</td><script>window.hacked=1</script><img src=x onerror="window.hacked=1"> $x$ $title'
SETTINGS = AnalysisSettings()


@pytest.fixture(scope="module")
def analysis():
    """Two people, a script and raters, whose every word is hostile."""
    records = [
        episode(code, number, kind=kind, about_device={"script": HOSTILE}, role=HOSTILE,
                device="scripted" if code == "S01" else "mouse")
        for code in ("P01", "P02", "S01") for kind in ("practise", "play") for number in range(2)
    ]  # fmt: skip
    participants = {
        code: replace(one, role=HOSTILE) for code, one in everybody(records, {"S01"}).items()
    }
    plan = toy_plan(title=HOSTILE)
    assert WatchStage in map(type, plan.roles["novice"].stages)
    study = StudyData(plan, {}, participants, tuple(records), (), 1)
    found = analyse(study, {"a": robot()}, [], SETTINGS)
    judged = judge("correspondence", HOSTILE, halves(), (), SETTINGS)
    return replace(found, judged=(judged,))


@pytest.fixture
def shown(analysis, visit, tmp_path):
    """The page in the browser."""
    path = tmp_path / "study.html"
    path.write_text(study_page(analysis), encoding="utf-8")
    return lambda **settings: visit(path, **settings)


def test_hostile_words_are_shown_and_never_run(shown):
    with shown() as page:
        assert page.evaluate("window.hacked") is None
        assert HOSTILE in page.locator("h1").inner_text()
        assert page.locator("script, img").count() == 0
        assert "scripted, no person" in page.locator("figure").first.inner_html()


def test_it_says_k_of_n_and_what_the_raters_found(shown):
    with shown() as page:
        findings = page.locator(".findings").first.inner_text()
        assert "2 of 2, at most 100 %, lie above the frontier" in findings
        assert "chose the recorded motion" in findings
        notes = page.locator(".notes").inner_text()
        assert "1 scripted participant(s): shown as such, counted nowhere" in notes
        assert "1 participant(s) withdrew and are deleted" in notes


def test_a_phone_scrolls_tables_and_not_the_page(shown):
    with shown(viewport={"width": 390, "height": 844}) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_the_keyboard_opens_the_players_and_reaches_their_table(shown):
    with shown() as page:
        summary = page.locator("summary").first
        summary.focus()
        page.keyboard.press("Enter")
        assert page.locator("details").first.get_attribute("open") is not None
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.className") == "wide"
