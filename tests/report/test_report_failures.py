"""The section of failure modes in a browser: what it says, and how it leads to the replays."""

from __future__ import annotations

import copy

import pytest
from playwright.sync_api import expect

from rigid.report import build_report

HOSTILE = '<img src=x onerror="window.hacked=1">'


@pytest.fixture
def modes(payload):
    return payload["failures"]["modes"]


def rows(page):
    return page.locator(".mode")


def watch(page, index):
    return rows(page).nth(index).get_by_role("button")


def time(page):
    return page.locator(".time").inner_text()


def test_a_mode_says_who_shows_it_how_natural_they_are_and_how_often(page, payload, modes):
    assert rows(page).count() == len(modes)
    for index, mode in enumerate(modes):
        text = " ".join(rows(page).nth(index).inner_text().split())
        low, high = mode["naturalness"]
        humans = f"{len(mode['points'])} of {payload['failures']['humans']} humans"
        assert f"{mode['title']} {mode['meaning']}" in text
        assert f"{humans}, naturalness {low:.2f} to {high:.2f}" in text
        assert f"about {round(100 * mode['share'])} % of all episodes" in text


def test_the_most_natural_example_says_which_episode_when_and_what(page, modes):
    for index, mode in enumerate(modes):
        text = " ".join(rows(page).nth(index).locator(".mode-example").inner_text().split())
        example = mode["example"]
        assert text.startswith(
            f"{example['id']}, {example['episode']} episode, naturalness "
            f"{example['naturalness']:.2f}, at {example['time']:.1f} s"
        )
        assert example["says"][1:] in text  # The first letter is a capital.


def test_watch_opens_the_episode_at_its_moment_and_takes_the_keyboard_there(page, modes):
    for index, mode in enumerate(modes):  # One example is a worst episode, the other a median one.
        example = mode["example"]
        watch(page, index).focus()
        page.keyboard.press("Enter")
        assert page.locator(".details").get_attribute("data-point") == example["id"]
        episode = page.get_by_role("button", name=example["episode"], exact=True)
        expect(episode).to_have_attribute("aria-pressed", "true")
        assert time(page) == f"{example['time']:.1f} s"
        expect(page.get_by_role("button", name="Play")).to_be_focused()
        expect(page.locator(".pane.attack canvas")).to_be_in_viewport()
    assert {mode["example"]["episode"] for mode in modes} == {"worst", "median"}


def test_watch_leads_back_to_the_moment_however_often(page, modes):
    for _ in range(2):
        watch(page, 0).click()
        assert time(page) == f"{modes[0]['example']['time']:.1f} s"
        page.get_by_label("Time").fill("3")
        assert time(page) == "0.3 s"


def test_the_replay_says_what_went_wrong_and_leads_to_the_moment(page, modes):
    example = modes[0]["example"]
    watch(page, 0).click()
    page.get_by_label("Time").fill("3")
    said = page.locator(".failure-says")
    moment = f"{example['time']:.1f} s"
    assert said.inner_text() == f"What went wrong, at {moment}: {example['says']}."
    said.get_by_role("button", name=moment).click()
    assert time(page) == moment


def test_the_strip_has_a_line_for_each_human_of_the_mode_and_a_dot_for_all_others(
    page, payload, modes
):
    members = len(modes[0]["points"])
    strip = rows(page).first.locator(".rug")
    assert strip.locator(".rug-line").count() == members
    assert strip.locator(".rug-other").count() == len(payload["frontier"]["points"]) - members
    assert strip.locator(".rug-line.example circle").count() == 1
    assert strip.get_by_role("img").get_attribute("aria-label").startswith(f"{members} of ")


def test_the_strip_follows_the_chosen_human(page, modes):
    shared = modes[0]["points"][1]
    page.locator(f'.frontier-chart [data-id="{shared}"]').dispatch_event("click")
    chosen = rows(page).first.locator(".rug-line.chosen")
    assert chosen.count() == 1
    assert chosen.locator("circle").count() == 0  # It is not the example.


def opened(visit, payload, tmp_path, failures):
    """A page of this section and little else: nothing in 3D."""
    bare = {**payload, "learning": {}, "discriminators": None, "scene": None, "replays": None}
    return visit(build_report({**bare, "failures": failures}, tmp_path / "report.html"))


@pytest.mark.parametrize(
    ("failures", "said"),
    [
        (None, "How episodes failed is unknown"),
        ({"humans": 2, "modes": [], "unseen": 0.0}, "every human found were helped."),
        ({"humans": 2, "modes": [], "unseen": 0.03}, "3 % failed in ways that neither shows."),
        ({"humans": 2, "modes": [], "unseen": 1e-4}, "less than 1 % failed in ways that neither"),
    ],
    ids=["unknown", "none", "some unseen", "few unseen"],
)
def test_where_there_are_no_modes_it_says_why(visit, payload, tmp_path, failures, said):
    with opened(visit, payload, tmp_path, failures) as page:
        assert said in " ".join(page.locator(".failure-modes .empty").inner_text().split())
        assert rows(page).count() == 0


def test_hostile_texts_stay_texts_and_paper_has_all_but_the_buttons(visit, payload, tmp_path):
    failures = copy.deepcopy(payload["failures"])
    first = failures["modes"][0]
    first |= {"title": HOSTILE, "meaning": HOSTILE, "points": [HOSTILE], "kind": HOSTILE}
    first["example"] |= {"id": HOSTILE, "says": HOSTILE, "episode": HOSTILE}
    with opened(visit, payload, tmp_path, failures) as page:
        assert page.evaluate("window.hacked") is None
        assert page.locator("img").count() == 0
        assert rows(page).first.locator("h3").inner_text() == HOSTILE
        watch(page, 0).click()  # Leads to nobody.
        page.emulate_media(media="print")
        assert not watch(page, 1).is_visible()
        assert rows(page).nth(1).locator(".mode-says").is_visible()
        assert rows(page).nth(1).locator(".rug svg").is_visible()
