"""Whole sessions: from the link to the completion code."""

import numpy as np
import pytest

from tests.study.page.conftest import SMALL, STEPS
from tests.study.page.sessions import (
    MAIN,
    act,
    begin_practice,
    card,
    moved,
    on_question,
    on_screen,
    replayed,
    running,
    travelled,
    until,
)

GIVEN = {
    ("correspondence", "right"): 1,
    ("goal", "left"): 7, ("goal", "right"): 0,
    ("danger", "left"): 2, ("danger", "right"): 5,
    ("naturalness", "left"): 6, ("naturalness", "right"): 1,
}  # fmt: skip
"""What the raters of these tests answer, by question and side."""


def test_a_session_by_mouse_ends_with_the_code_and_every_episode_stored(invite, visit):
    participant = invite("novice")
    with visit(participant) as page:
        assert "pseudonymous" in page.inner_text(".prose")
        page.click(MAIN)
        assert page.inner_text("#consent-problem") == "To take part, please tick the first box."
        page.check("#agreed")
        page.click(MAIN)
        on_screen(page, "demographics")
        page.fill("#age", "31")
        page.check("#handedness-left")
        page.click(MAIN)
        on_screen(page, "watch")
        page.click(MAIN)  # Enabled once the episode was seen.
        with participant.held():
            begin_practice(page, "mouse")
            drag(page)
        card(page, "Episode 1 of 1")
        with participant.held():
            act(page, "start")
            drag(page)
        page.emulate_media(reduced_motion="reduce")  # Motions wait to be played: cheaper to draw.
        choose(page, "correspondence-right")
        choose(page, "goal-left-7", "goal-right-0", "danger-left-2", "danger-right-5")
        choose(page, "naturalness-left-6", "naturalness-right-1")
        on_screen(page, "done")
        assert page.inner_text(".code") == "TEST-1234"

    stored = participant.service.store.participant(participant.code)
    assert stored.status == "done"
    assert dict(stored.demographics) == {"age": 31, "handedness": "left"}
    practice, play = participant.episodes()
    assert (practice.kind, play.kind) == ("practise", "play")
    for record in (practice, play):
        assert record.device == "mouse"
        assert len(record.arrays.targets) == STEPS
        assert moved(record) > 0.02
        np.testing.assert_array_equal(replayed(record), record.arrays.states)
    assert answers(participant) == GIVEN


def choose(page, *answers: str) -> None:
    """Answers one questionnaire of one pair, by mouse; each answer is a name and a value."""
    page.click(".judge-intro button.primary")
    on_question(page)
    for answer in answers:
        name, _, value = answer.rpartition("-")
        page.check(f".judge input[name={name}][value='{value}']")
    page.click(".judge form button.primary")


def answers(participant) -> dict[tuple[str, str], float]:
    """(question, side) → response; 1 at the side that was chosen."""
    found = {}
    for one in participant.service.store.answers(participant.code):
        second = "right" if one.shown_left == "first" else "left"
        if one.of == "both":
            found[one.question, second if one.response else other(second)] = 1
        else:
            found[one.question, second if one.of == "second" else other(second)] = one.response
    return found


def other(side: str) -> str:
    return "left" if side == "right" else "right"


def drag(page) -> None:
    """Once the episode runs, from the middle of the picture to its upper right."""
    running(page)
    page.targets.clear()
    x, y = SMALL["width"] / 2, 0.6 * SMALL["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y - 60)
    page.mouse.up()
    until(page, lambda: len(page.targets) > 0)


@pytest.mark.slow
def test_one_finger_moves_the_hand_and_two_that_part_bring_it_closer(invite, visit):
    participant = invite("player").ready()
    with visit(participant, has_touch=True, is_mobile=True) as page:
        fingers = page.context.new_cdp_session(page)
        card(page, "Episode 1 of 2")
        with participant.held():
            act(page, "touch")
            act(page, "start")
            running(page)
            slide(fingers, lambda share: [(160 + 40 * share, 200 - 60 * share)])
            until(page, lambda: page.targets)
            up = page.targets[-1]
            slide(fingers, lambda share: [(140 - 60 * share, 200), (180 + 60 * share, 200)])
            until(page, lambda: np.linalg.norm(np.subtract(page.targets[-1], up)) > 0.05)
        card(page, "Episode 2 of 2")
    (record,) = participant.episodes()
    assert record.device == "touch"
    targets = record.arrays.targets
    assert up[2] > targets[0, 2] + 0.05
    assert targets[-1, 1] < up[1] - 0.03  # Towards the eye: the person looks along −y, to us.
    np.testing.assert_array_equal(replayed(record), record.arrays.states)


def slide(fingers, at) -> None:
    """Puts fingers down, moves them from share 0 to 1 of a way, and takes them off."""
    for step in range(9):
        points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(at(step / 8))]
        kind = "touchMove" if step else "touchStart"
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    fingers.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


@pytest.mark.slow
def test_a_session_by_keyboard_alone(invite, visit):
    participant = invite("novice")
    with visit(participant) as page:
        press = page.keyboard.press
        page.focus("body")
        while page.evaluate("document.activeElement.id") != "agreed":
            press("Tab")
        press("Space")
        press("Enter")  # Sends the form.
        on_screen(page, "demographics")
        while "Skip" not in page.evaluate("document.activeElement.textContent"):
            press("Tab")
        press("Enter")
        on_screen(page, "watch")
        page.wait_for_selector(MAIN)
        while page.evaluate("document.activeElement.textContent") != "Next":
            press("Tab")
        press("Enter")
        card(page, "Practice 1 of 1")
        press("Enter")  # The card takes the focus to what comes next.
        press("Tab")
        assert page.evaluate("document.activeElement.textContent") == "Keyboard"
        with participant.held():
            press("Enter")
            press("Enter")
            press("Enter")
            hold(page, "ArrowUp")
        card(page, "Episode 1 of 1")
        with participant.held():
            press("Enter")
            hold(page, "KeyA")
        for keys in ("b", "7025", "61"):
            page.wait_for_selector(".judge-intro")
            press("Tab")  # From the heading, where the page puts the focus.
            press("Enter")
            on_question(page)
            for key in (*keys, "Enter"):
                press(key)
        on_screen(page, "done")

    up, left = participant.episodes()
    assert (up.device, left.device) == ("keyboard", "keyboard")
    assert up.arrays.targets[-1, 2] > up.arrays.targets[0, 2] + 0.05
    offsets = left.arrays.targets - left.arrays.targets[0]
    # Held for longer, it would slide along the sphere that the arm can reach.
    first = offsets[np.linalg.norm(offsets[:, :2], axis=1) > 0.03][0]
    assert abs(first[2]) < 0.02
    assert answers(participant) == GIVEN


def hold(page, key: str) -> None:
    """Once the episode runs, holds a key down until the hand went far enough."""
    running(page)
    page.targets.clear()
    page.keyboard.down(key)
    travelled(page, 0.06)
    page.keyboard.up(key)


def test_deleting_everything_is_three_presses_away_at_any_time(invite, visit):
    participant = invite("player").ready()
    with visit(participant) as page:
        card(page, "Episode 1 of 2")
        page.click("button.stop")
        page.click("text=Stop, and delete everything about me.")
        page.click("dialog >> text=Delete everything >> nth=-1")
        on_screen(page, "withdrawn")
    codes = [person.code for person in participant.service.store.participants()]
    assert participant.code not in codes


@pytest.mark.slow
def test_a_lost_connection_begins_the_episode_anew_by_itself(invite, visit):
    participant = invite("player").ready()
    with visit(participant) as page:
        sockets = []

        def through(route):
            sockets.append(route)
            route.connect_to_server()

        page.route_web_socket("**/live", through)
        page.reload()
        card(page, "Episode 1 of 2")
        with participant.held():
            act(page, "mouse")
            act(page, "start")
            running(page)
            sockets[-1].close(code=1012, reason="as if the network went")
            page.wait_for_function(
                "document.querySelector('.play-card h1')?.textContent.endsWith('is gone.')"
            )
        card(page, "Episode 2 of 2")
    (record,) = participant.episodes()
    assert record.attempts == 2
    assert len(record.arrays.targets) == STEPS


@pytest.mark.slow
def test_at_twice_the_size_nothing_leaves_the_page(invite, visit):
    participant = invite("novice")
    half = {"width": 640, "height": 400}  # A window of 1280 × 800 at 200 %.
    with visit(participant, viewport=half) as page:
        assert overflow(page) == 0
        page.check("#agreed")
        page.click(MAIN)
        on_screen(page, "demographics")
        assert overflow(page) == 0
        page.click("main button.quiet")
        on_screen(page, "watch")
        page.click(MAIN)
        card(page, "Practice 1 of 1")
        box = page.locator(".play-card").bounding_box()
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= 400
        assert overflow(page) == 0


def overflow(page) -> int:
    return page.evaluate(
        "document.documentElement.scrollWidth - document.documentElement.clientWidth"
    )
