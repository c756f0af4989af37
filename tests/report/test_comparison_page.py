"""The page of a comparison in a browser."""

from __future__ import annotations

import pytest

from rigid.frontier.standings import notes_of, standings_of
from rigid.frontier.successes import Played
from rigid.report.comparison import comparison_page
from tests.frontier.samples import measured

HOSTILE = '</td><script>window.hacked=1</script><img src=x onerror="window.hacked=1">'


@pytest.fixture
def write(tmp_path):
    """Writes the page of two methods; returns its path."""

    def page(robots, *, name="vanilla", played=(), notes=None):
        at = tmp_path / "out" / "page.html"
        at.parent.mkdir()
        standings = standings_of({name: robots, "robust": [measured({0: 0.3, 1: 0.4})]}, played)
        notes = notes_of(standings) if notes is None else notes
        at.write_text(comparison_page(standings, notes, at=at))
        return at

    return page


@pytest.fixture
def with_report(tmp_path):
    """A robot whose run directory has a report, and signs in its path that mean something."""
    directory = tmp_path / "javascript:a b#c?%20"
    directory.mkdir()
    (directory / "report.html").write_text("<title>the report</title>")
    return measured({0: 0.5, 1: 0.6}, directory=str(directory))


def test_it_shows_tables_curves_and_notes(write, visit, with_report):
    played = [Played(0, 0.5, 100), Played(1, 0.75, 100)]
    with visit(write([with_report], played=played)) as page:
        assert page.locator("h1").inner_text() == "vanilla, robust on reach · RIGID"
        methods, differences, robots = page.locator("table").all()
        cells = methods.locator("tbody tr").nth(1).locator("td").all_inner_texts()
        assert cells[0] == "robust"
        assert cells[3].split("\n")[0] == "0.75"
        assert cells[4].split("\n")[0] == "0.350"
        assert "-0.200" in differences.inner_text()
        assert "builtin:vanilla" in robots.inner_text()
        assert page.locator("figure svg").bounding_box()["width"] > 600
        assert "Lower is more robust" in page.locator(".notes").inner_text()


def test_a_link_leads_to_the_report_of_a_robot_that_has_one(write, visit, with_report):
    path = write([with_report])
    with visit(path) as page:
        (link,) = page.locator("a").all()
        assert link.get_attribute("href").startswith("../javascript%3Aa%20b")
        way = link.evaluate("link => link.href")
        assert page.locator("table").last.inner_text().count("none") == 1
    assert way == (with_report[0].directory / "report.html").as_uri()


def test_words_of_strangers_stay_words(write, visit):
    robot = measured(
        {0: 0.5, 1: 0.6}, robot=HOSTILE, human=HOSTILE, task=HOSTILE, preset=HOSTILE, stamp=HOSTILE
    )
    with visit(write([robot], name=HOSTILE, notes=[HOSTILE])) as page:
        assert page.evaluate("window.hacked") is None
        assert page.locator("script, img").count() == 0
        assert page.locator(".stamp").inner_text() == HOSTILE
        assert page.locator("table").last.inner_text().count(HOSTILE) == 3


def test_a_narrow_screen_scrolls_tables_and_not_the_page(write, visit, with_report):
    with visit(write([with_report]), viewport={"width": 400, "height": 800}) as page:
        assert page.evaluate("document.documentElement.scrollWidth") == 400


def test_robots_of_a_method_are_numbered(write, visit):
    with visit(write([measured({0: 0.5, 1: 0.6}), measured({0: 0.4, 1: 0.5})])) as page:
        names = page.locator("table").last.locator("tbody tr td:first-child").all_inner_texts()
    assert names == ["vanilla 1", "vanilla 2", "robust"]
