"""The report where it is put to the test: hostile texts, narrow screens, runs that show little."""

from __future__ import annotations

import copy
import re

import numpy as np
import pytest

from rigid.report import build_report
from tests.browser import TWO_FRAMES
from tests.report.sample_payload import worst_natural

HOSTILE = '</script><img src=x onerror="window.hacked=1">\'"\u2028{{7*7}}\ud800'


@pytest.fixture(scope="module")
def hostile_report(payload, tmp_path_factory):
    hostile = copy.deepcopy({**payload, "learning": {}})
    frontier = hostile["frontier"]
    frontier |= {"robot": HOSTILE, "task": HOSTILE, "preset": HOSTILE, "range_source": HOSTILE}
    frontier["canonical"]["source"] = HOSTILE
    old = worst_natural(payload)
    point = next(p for p in frontier["points"] if p["id"] == old)
    point |= {"id": HOSTILE, "naturalness_all": {HOSTILE: 0.5}, HOSTILE: HOSTILE}
    frontier["points"].append({"id": {"not": "text"}, "lambda": [], "naturalness": "0.5"})
    motion = hostile["replays"].pop(old)
    motion["worst"] |= {"outcome": HOSTILE, "contacts": [HOSTILE, [None] * 6]}
    hostile["replays"][HOSTILE] = motion
    hostile["settings"] = {HOSTILE: {HOSTILE: [HOSTILE]}, "__proto__": {"servo": "datasheet"}}
    hostile["stamp"] = HOSTILE
    return build_report(hostile, tmp_path_factory.mktemp("hostile") / "report.html")


def test_hostile_texts_are_shown_and_never_run(visit, hostile_report):
    with visit(hostile_report) as page:
        assert page.evaluate("window.hacked") is None
        assert page.locator("img").count() == 0
        assert "<img src=x" in page.locator("h1").inner_text()
        assert "<img src=x" in page.locator(".pane.attack .pane-name").inner_text()
        assert "<img src=x" in page.locator(".details h2").inner_text()
        page.get_by_text("Settings of this run").click()
        assert "<img src=x" in page.locator(".tree").first.inner_text()
        assert page.locator("table.points tbody tr").count() == 37


def test_no_viewport_scrolls_sideways(visit, report):
    with visit(report, viewport={"width": 390, "height": 800}, has_touch=True) as page:
        for width in (390, 320, 480, 768):
            page.set_viewport_size({"width": width, "height": 800})
            page.evaluate(TWO_FRAMES)
            assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize("width", [320, 390, 1000])
def test_even_a_full_success_stays_in_its_column(visit, payload, tmp_path, width):
    perfect = copy.deepcopy(payload["frontier"])
    for part in (perfect["canonical"], *perfect["points"]):
        part["success"] = 1.0
    file = build_report({"frontier": perfect}, tmp_path / "report.html")
    with visit(file, viewport={"width": width, "height": 800}) as page:
        figure = page.locator("#success .figure-value")
        assert figure.inner_text() == "1.00 → 1.00"
        assert figure.evaluate("e => e.scrollWidth <= e.clientWidth")


def brightness(page):
    color = page.evaluate("getComputedStyle(document.body).backgroundColor")
    return np.mean([int(channel) for channel in re.findall(r"\d+", color)[:3]])


def test_theme_follows_the_system_and_the_switch_and_paper_is_light(visit, report):
    with visit(report, color_scheme="dark") as page:
        assert brightness(page) < 60
        page.get_by_role("button", name="Light theme").click()
        assert brightness(page) > 200
        page.get_by_role("button", name="Dark theme").click()
        assert brightness(page) < 60
        page.emulate_media(media="print")
        assert brightness(page) > 200
        assert not page.locator(".transport-options").is_visible()
        assert page.locator("details:not([open])").count() == 0


def test_one_seed_says_that_it_has_no_interval_and_absent_replays_are_said(
    visit, sample_payload, tmp_path
):
    single = sample_payload(seeds=1, replays=0) | {"replays": None, "scene": None, "passive": None}
    with visit(build_report(single, tmp_path / "report.html")) as page:
        texts = page.locator(".headline .interval").all_inner_texts()
        assert texts[:3] == ["one seed: no interval"] * 3
        assert page.get_by_text("This task shows no picture").is_visible()
        assert page.locator("canvas").count() == 0


@pytest.mark.parametrize("absent", ["scene", "replays"])
def test_a_report_without_motion_invites_nobody_to_watch_and_shows_numbers_beside_the_chart(
    visit, sample_payload, tmp_path, absent
):
    still = sample_payload(seeds=1, replays=0) | {absent: None, "failures": None}
    with visit(build_report(still, tmp_path / "report.html")) as page:
        captions = " ".join(page.locator("figcaption").all_inner_texts())
        assert "Choose a round mark or a cross to read its numbers" in captions
        assert "to watch it" not in page.locator("main").inner_text()
        chart, numbers = (page.locator(f".stage {part}").bounding_box()
                          for part in (".frontier-chart", ".details"))  # fmt: skip
        assert numbers["x"] > chart["x"] + chart["width"]
        assert numbers["y"] < chart["y"] + chart["height"]


def test_a_human_without_a_stored_episode_cannot_be_played(visit, sample_payload, tmp_path):
    payload = sample_payload(seeds=1, replays=1)
    played = worst_natural(payload)
    points = [point["id"] for point in payload["frontier"]["points"]]
    other = next(name for name in points if name != played)
    with visit(build_report(payload, tmp_path / "report.html")) as page:
        for name, playable in ((other, False), (played, True)):
            page.locator(f'.frontier-chart [data-id="{name}"]').dispatch_event("click")
            assert page.get_by_role("button", name="Play").is_enabled() == playable


def test_humans_whose_marks_cover_each_other_are_chosen_one_after_the_other(
    visit, sample_payload, tmp_path
):
    payload = sample_payload(seeds=1, replays=0)
    crowd = payload["frontier"]["points"][:3]
    for point in crowd:
        point |= {"naturalness": 0.5, "adversarialness": 0.5}
    names = {point["id"] for point in crowd}
    with visit(build_report(payload, tmp_path / "report.html")) as page:
        chart = page.locator(".frontier-chart")
        spot = chart.locator(f'[data-id="{crowd[0]["id"]}"]').bounding_box()
        place = spot["x"] + spot["width"] / 2, spot["y"] + spot["height"] / 2
        page.mouse.move(*place)
        assert "2 more below: click again for the next" in chart.locator(".tooltip").inner_text()
        chosen = []
        for _ in range(6):
            page.mouse.click(*place)
            chosen.append(chart.locator(".chosen").get_attribute("data-id"))
        assert set(chosen[:3]) == set(chosen[3:]) == names


def test_humans_below_the_canonical_mark_are_chosen_by_clicking_it(visit, sample_payload, tmp_path):
    payload = sample_payload(seeds=1, replays=0)
    canonical = payload["frontier"]["canonical"]
    covered = payload["frontier"]["points"][:2]
    for point in covered:
        point |= {"naturalness": 1.0, "adversarialness": canonical["adversarialness"]}
    with visit(build_report(payload, tmp_path / "report.html")) as page:
        chart = page.locator(".frontier-chart")
        spot = chart.locator(".mark.canonical").bounding_box()
        place = spot["x"] + spot["width"] / 2, spot["y"] + spot["height"] / 2
        page.mouse.move(*place)
        assert "2 found below: click for the next" in chart.locator(".tooltip").inner_text()
        chosen = []
        for _ in range(4):
            page.mouse.click(*place)
            chosen.append(chart.locator(".chosen").get_attribute("data-id"))
        assert chosen[:2] == chosen[2:]
        assert set(chosen) == {point["id"] for point in covered}


def test_a_task_with_outcomes_of_its_own_and_without_forces_shows_what_it_has(
    visit, sample_payload, tmp_path
):
    foreign = sample_payload(seeds=1, replays=0) | {"replays": None, "scene": None}
    for point in foreign["frontier"]["points"]:
        point |= {"outcomes": {"ended_early": 0.25, "ran its time": 0.75}}
        point |= {"peak_force": None, "impulse": None, "success": None}
    with visit(build_report(foreign, tmp_path / "report.html")) as page:
        shown = page.locator(".details").inner_text()
        assert "ended early\n25" in shown
        assert "ran its time\n75" in shown
        assert "force" not in shown
        assert "Forces are not physical" not in page.locator("main").inner_text()
        assert page.get_by_role("columnheader", name="success").count() == 0
        assert page.get_by_text("This task has outcomes of its own").is_visible()


def test_frontier_without_points_is_shown_as_unknown(visit, tmp_path):
    empty = {"frontier": {"schema": 1, "points": [], "auc": np.nan}, "settings": {}}
    with visit(build_report(empty, tmp_path / "report.html")) as page:
        assert page.locator("#auc .figure-value").inner_text() == "—"
        assert page.get_by_text("No human was measured.").is_visible()
