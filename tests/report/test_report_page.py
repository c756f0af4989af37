"""The report in a browser: what a reader sees, clicks, types, prints."""

from __future__ import annotations

import csv
import re

from playwright.sync_api import expect

from rigid.frontier.result import lacking
from rigid.report import build_report
from tests.browser import TWO_FRAMES
from tests.report.sample_payload import worst_natural

COLOURS_DRAWN = """canvas => {
  const copy = document.createElement("canvas");
  copy.width = copy.height = 96;
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0, 96, 96);
  const data = context.getImageData(0, 0, 96, 96).data;
  return new Set(new Uint32Array(data.buffer)).size;
}"""


def mark(page, point_id):
    return page.locator(f'.frontier-chart [data-id="{point_id}"]')


def shown(page):
    return page.locator(".details").get_attribute("data-point")


def picture(page, pane):
    return page.locator(f".pane.{pane} canvas").evaluate("canvas => canvas.toDataURL()")


def test_headline_numbers_are_those_of_the_payload(page, payload):
    frontier = payload["frontier"]
    for name, value, interval in (
        ("worst", frontier["worst_at"]["0.9"], frontier["worst_at_interval"]["0.9"]),
        ("auc-natural", frontier["auc_natural"], frontier["auc_natural_interval"]),
        ("auc", frontier["auc"], frontier["auc_interval"]),
    ):
        box = page.locator(f"#{name}")
        assert box.locator(".figure-value").inner_text() == f"{value:.2f}"
        low, high = interval
        assert box.locator(".interval").inner_text() == f"[{low:.2f}, {high:.2f}]"


def test_beside_the_mean_over_seeds_stands_the_worst_of_all(page, payload):
    worst = max(payload["frontier"]["worst_at_by_seed"]["0.9"].values())
    said = " ".join(page.locator("#worst").inner_text().split())
    assert f"mean over seeds of each seed's worst; the worst of all: {worst:.2f}" in said
    assert page.locator(".lacking").count() == 0


def test_a_headline_that_rests_on_canonical_play_says_so_beside_it(visit, payload, tmp_path):
    words = lacking(0, 6, 0.9)
    with visit(build_report({**payload, "lacking": words}, tmp_path / "report.html")) as page:
        said = page.locator("#worst .lacking")
        assert said.inner_text() == words
        assert said.is_visible()
        value = page.locator("#worst .figure-value").evaluate("e => getComputedStyle(e).color")
        assert said.evaluate("e => getComputedStyle(e).borderLeftColor") == value
        assert "canonical play where a seed found nobody" in page.locator("#success").inner_text()


def test_the_legend_says_what_a_mark_under_the_line_is(page):
    figure = page.locator(".frontier-figure")
    assert "not dominated" in figure.locator(".legend").inner_text()
    assert "no other human is both more natural" in figure.locator("figcaption").inner_text()


def test_head_names_robot_task_and_canonical_source(page):
    assert page.locator("h1").inner_text() == "builtin:vanilla on itch-scratching"
    facts = page.locator(".facts").inner_text()
    assert re.search(r"canonical play\s+synthetic, n = 200", facts)
    assert page.locator(".stamp").inner_text() == "synthetic sample: not a measurement"


def test_page_opens_on_the_worst_natural_human(page, payload):
    assert shown(page) == worst_natural(payload)


def test_every_human_is_on_the_chart(page, payload):
    frontier = sum(p["on_frontier"] for p in payload["frontier"]["points"])
    assert page.locator(".frontier-chart .mark.frontier").count() == frontier
    assert page.locator(".frontier-chart .mark.dominated").count() == 36 - frontier
    assert page.locator(".frontier-chart .mark.passive").count() == 1
    assert page.locator(".frontier-chart .mark.canonical").count() == 1


def test_click_on_a_mark_shows_its_numbers(page, payload):
    point = payload["frontier"]["points"][0]
    mark(page, point["id"]).dispatch_event("click")
    assert shown(page) == point["id"]
    details = page.locator(".details").inner_text()
    assert f"{point['adversarialness']:.2f}" in details
    assert f"{point['naturalness_all']['window16_k16']:.2f}" in details
    assert page.url.endswith(f"#human={point['id']}")


def test_whose_fault_it_was_is_said_where_it_is_known(visit, tmp_path, payload):
    chosen = dict(payload["frontier"]["points"][0], verdict="another policy copes", regret=0.25)
    frontier = {**payload["frontier"], "points": [chosen]}
    file = build_report({**payload, "frontier": frontier}, tmp_path / "report.html")
    with visit(file) as page:
        details = page.locator(".details").inner_text()
    assert "a fresh robot" in details
    assert "another policy copes regret 0.25" in " ".join(details.split())


def test_human_without_stored_motion_says_so(page, payload):
    mark(page, payload["frontier"]["points"][0]["id"]).dispatch_event("click")
    assert page.get_by_text("No episode of this human was stored.").is_visible()


def test_arrow_keys_walk_by_naturalness_and_enter_chooses(page, payload):
    by_naturalness = sorted(
        [*payload["frontier"]["points"], {"id": "passive", **payload["passive"]}],
        key=lambda p: (p["naturalness"], p["adversarialness"]),
    )
    first, third = by_naturalness[0]["id"], by_naturalness[2]["id"]
    mark(page, first).focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.dataset.id") == third
    assert page.locator(".frontier-chart .tooltip").is_visible()
    page.keyboard.press("Enter")
    assert shown(page) == third
    assert mark(page, third).get_attribute("aria-pressed") == "true"


def test_chart_is_one_tab_stop(page):
    assert page.locator('.frontier-chart .mark[tabindex="0"]').count() == 1


def test_both_views_are_drawn_and_move_together(page, payload):
    mark(page, worst_natural(payload)).dispatch_event("click")
    for pane in ("attack", "natural"):
        assert page.locator(f".pane.{pane} canvas").evaluate(COLOURS_DRAWN) > 50
    before = picture(page, "attack"), picture(page, "natural")
    page.get_by_label("Time").fill("3")
    page.evaluate(TWO_FRAMES)
    assert picture(page, "attack") != before[0]
    assert picture(page, "natural") != before[1]


def test_turning_one_view_turns_the_other(page, payload):
    mark(page, worst_natural(payload)).dispatch_event("click")
    page.evaluate(TWO_FRAMES)
    before = picture(page, "natural")
    page.locator(".pane.attack canvas").focus()
    page.keyboard.press("ArrowLeft")
    page.evaluate(TWO_FRAMES)
    turned = picture(page, "natural")
    assert turned != before
    page.get_by_role("button", name="reset view").click()
    page.evaluate(TWO_FRAMES)
    assert picture(page, "natural") != turned


def test_overlay_lays_the_canonical_human_over_the_chosen_one(page, payload):
    mark(page, worst_natural(payload)).dispatch_event("click")
    page.evaluate(TWO_FRAMES)
    before = picture(page, "attack")
    overlay = page.get_by_role("button", name="overlay")
    overlay.click()
    page.evaluate(TWO_FRAMES)
    assert overlay.get_attribute("aria-pressed") == "true"
    assert picture(page, "attack") != before
    overlay.click()


def test_median_episode_is_another_than_the_worst(page, payload):
    chosen = worst_natural(payload)
    mark(page, chosen).dispatch_event("click")
    page.get_by_role("button", name="median").click()
    page.get_by_label("Time").fill("60")
    distance = payload["replays"][chosen]["median"]["distance"][60]
    assert page.locator(".strip-value").nth(2).inner_text() == f"{100 * distance:.1f} cm"
    page.get_by_role("button", name="worst").click()


def test_strips_read_the_recorded_values(page, payload):
    chosen = worst_natural(payload)
    mark(page, chosen).dispatch_event("click")
    page.get_by_label("Time").fill("40")
    values = page.locator(".strip-value").all_inner_texts()
    clip = payload["replays"][chosen]["worst"]
    assert values[0] == f"{clip['force_unwanted'][40]:.1f} N"
    assert values[2] == f"{100 * clip['distance'][40]:.1f} cm"
    assert values[3] == f"{clip['counted'][40]:.0f}"


def test_play_goes_on_until_pause(page, payload):
    mark(page, worst_natural(payload)).dispatch_event("click")
    page.get_by_label("Time").fill("0")
    page.get_by_role("button", name="Play").click()
    expect(page.locator(".time")).not_to_have_text("0.0 s")
    page.get_by_role("button", name="Pause").click()
    stopped = page.locator(".time").inner_text()
    page.evaluate(TWO_FRAMES)
    assert page.locator(".time").inner_text() == stopped


def test_a_chosen_human_is_shown_at_its_telling_moment_and_played_from_its_start(page, payload):
    for chosen in ("passive", worst_natural(payload)):  # Who is shown already is not opened anew.
        mark(page, chosen).dispatch_event("click")
    assert page.locator(".time").inner_text() != "0.0 s"
    started = page.get_by_role("button", name="Play").evaluate(
        "button => { button.click(); return document.querySelector('.time').textContent; }"
    )
    assert started == "0.0 s"


def test_play_goes_on_from_a_moment_that_somebody_went_to(page, payload):
    mark(page, worst_natural(payload)).dispatch_event("click")
    page.get_by_label("Time").fill("40")
    started = page.get_by_role("button", name="Play").evaluate(
        "button => { button.click(); return document.querySelector('.time').textContent; }"
    )
    assert started == "4.0 s"


def test_forces_of_the_papers_servo_are_marked_not_physical(page):
    assert "not physical" in page.locator(".details").inner_text()


def test_table_sorts_both_ways(page):
    def column():
        return page.locator("table.points tbody td:nth-child(6)").all_inner_texts()

    head = page.get_by_role("columnheader", name="adversarialness")
    head.get_by_role("button").click()
    assert column() == sorted(column(), reverse=True)
    assert head.get_attribute("aria-sort") == "descending"
    head.get_by_role("button").click()
    assert column() == sorted(column())


def test_csv_holds_every_point_at_full_precision(page, payload):
    with page.expect_download() as event:
        page.get_by_role("button", name="Download CSV").click()
    rows = list(csv.DictReader(event.value.path().read_text(encoding="utf-8").splitlines()))
    points = {p["id"]: p for p in payload["frontier"]["points"]}
    assert {row["id"] for row in rows} == set(points)
    for row in rows:
        assert float(row["naturalness"]) == points[row["id"]]["naturalness"]
        assert float(row["outcomes.helped"]) == points[row["id"]]["outcomes"]["helped"]


def test_learning_curves_follow_the_chosen_human(page, payload):
    point = payload["frontier"]["points"][0]["id"]
    mark(page, point).dispatch_event("click")
    last = payload["learning"][point]["return"][-1]
    reading = page.locator(".panel").first.locator(".reading").inner_text()
    assert reading.replace("\u2212", "-") == f"{last:.0f}"


def test_every_figure_says_what_it_does_not_show(page):
    captions = page.locator("figcaption .caveat").all_inner_texts()
    assert len(captions) == page.locator("figure").count() + 1  # The table has one as well.
    assert all(captions)
    assert "worst quarter of canonical behaviour" in captions[0]
