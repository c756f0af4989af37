"""What the chosen human's discriminator tells apart, in a browser."""

from __future__ import annotations

import copy
import re

import pytest

from rigid.report import build_report


def choose(page, point_id):
    page.locator(f'.frontier-chart [data-id="{point_id}"]').dispatch_event("click")


@pytest.fixture
def chosen(page, payload):
    """The first human, its seed's payload and its own."""
    point = payload["frontier"]["points"][0]
    choose(page, point["id"])
    seen = payload["discriminators"][str(point["seed"])]
    return point, seen, seen["judged"][point["id"]]


def reading(page):
    """What stands beside the title of the chart of noise: noise, discriminator, referee."""
    return page.locator(".told .reading").inner_text().replace("\u202f", " ")


def test_the_reading_line_says_what_both_judges_say(page, chosen):
    _, seen, judged = chosen
    chart = page.get_by_role("img", name="Held-out canonical motion under noise")
    chart.focus()
    page.keyboard.press("ArrowRight")
    for index in (-1, -2):
        shares = (judged[judge]["canonical"][index] for judge in ("discriminator", "referee"))
        numbers = [seen["levels"][index], *(round(100 * share) for share in shares)]
        assert [float(text) for text in re.findall(r"[\d.]+", reading(page))] == numbers
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("Tab")


def test_the_other_lambdas_of_the_seed_lie_behind(page, chosen):
    assert page.locator(".told path.told-other").count() == len(chosen[1]["judged"]) - 1
    assert page.locator(".told .panel-head + .canvas path.told-discriminator").count() == 1


def test_every_human_of_the_seed_has_a_mark_that_says_its_share(page, chosen):
    point, seen, judged = chosen
    marks = page.locator(".told .mark")
    assert marks.count() == len(seen["judged"])
    share = round(100 * judged["discriminator"]["adversaries"][point["id"]])
    label = page.locator(f'.told [data-id="{point["id"]}"]').get_attribute("aria-label")
    assert f"discriminator {share}\u202f%" in label
    assert page.locator(".told .mark.chosen").get_attribute("data-id") == point["id"]


@pytest.mark.usefixtures("chosen")
def test_choosing_a_mark_chooses_that_human(page, payload):
    mate = payload["frontier"]["points"][1]["id"]
    page.locator(f'.told [data-id="{mate}"]').dispatch_event("click")
    assert page.locator(".details").get_attribute("data-point") == mate
    assert page.locator(".told .mark.chosen").get_attribute("data-id") == mate


def test_every_pose_has_a_verdict_that_does_not_need_colour(page, chosen):
    scores = chosen[2]["scores"]
    panels = page.locator(".posture-panel")
    assert panels.count() == len(scores["noisy"]) + 1
    for index, level in enumerate([*scores["noisy"], scores["own"]]):
        natural = sum(score < 0 for score in level)
        panel = panels.nth(index)
        assert panel.locator(".posture.canonical circle.end").count() == natural
        assert panel.locator(".posture.other path.end").count() == len(level) - natural
        note = panel.locator(".note").inner_text()
        assert note == f"{natural} of {len(level)} taken for canonical"
    dashes = page.locator(".posture.other .bone").first.evaluate(
        "bone => getComputedStyle(bone).strokeDasharray"
    )
    assert dashes != "none"


@pytest.mark.usefixtures("chosen")
def test_poses_are_drawn_inside_their_pictures(page):
    inside = page.locator(".postures").evaluate_all("""pictures => pictures.every(picture => {
      const frame = picture.getBoundingClientRect();
      return [...picture.querySelectorAll(".bone")].every(bone => {
        const box = bone.getBoundingClientRect();
        return box.width > 0 && box.left >= frame.left && box.right <= frame.right
          && box.top >= frame.top && box.bottom <= frame.bottom;
      });
    })""")
    assert inside


def test_the_passive_human_has_no_discriminator(page):
    choose(page, "passive")
    text = page.locator(".told-figures").inner_text()
    assert text == "The passive human was never trained, so it has no discriminator."


def changed(payload, tmp_path, change):
    """A report whose discriminators were changed."""
    altered = copy.deepcopy(payload)
    change(altered)
    return build_report(altered, tmp_path / "report.html")


def without(payload):
    del payload["discriminators"]


def measure_without(payload):
    payload["frontier"]["search_measure"] = "<b>mmd</b>"
    for seen in payload["discriminators"].values():
        seen["judged"] = None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (without, "is unknown: it was not examined when this human was measured"),
        (measure_without, "The search measure of this run (<b>mmd</b>) trains no discriminator."),
    ],
    ids=["old run", "no discriminator"],
)
def test_a_run_without_discriminators_says_why(visit, payload, tmp_path, change, said):
    with visit(changed(payload, tmp_path, change)) as page:
        assert said in page.locator(".told-figures").inner_text()
        assert page.locator(".told-figures figure").count() == 0


def no_poses(payload):
    for seen in payload["discriminators"].values():
        seen["poses"] = None


def no_scene(payload):
    payload["scene"] = None


def broken_poses(payload):
    for seen in payload["discriminators"].values():
        seen["poses"]["noisy"]["poses"] = "</script>"


@pytest.mark.parametrize("change", [no_poses, no_scene, broken_poses])
def test_where_no_pose_can_be_drawn_the_shares_remain(visit, payload, tmp_path, change):
    with visit(changed(payload, tmp_path, change)) as page:
        assert page.locator(".told-figure").count() == 1
        assert page.locator(".posture-figure").count() == 0


def foreign(payload):
    seen = payload["discriminators"]["0"]
    for judged in seen["judged"].values():
        judged["discriminator"]["adversaries"] = {"__proto__": "x", "s0-r1-l0": "</script>"}
        judged["referee"] = {"canonical": [0.5]}
        judged["scores"] = {"noisy": [["</script>"]], "own": "many"}


def test_foreign_values_count_as_unknown(visit, payload, tmp_path):
    with visit(changed(payload, tmp_path, foreign)) as page:
        choose(page, "s0-r1-l0")
        assert page.locator(".told .mark").count() == 0
        assert page.locator(".told .told-referee, .told .referee-mark").count() == 0
        assert "referee" not in reading(page)
        assert page.locator(".posture-figure").count() == 0
