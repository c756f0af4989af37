"""The page of an examination in a browser."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.compute.doctor.domain import Diagnosis
from rigid.doctor.data import check_data
from rigid.doctor.ends import End, check_ends
from rigid.doctor.features import check_features
from rigid.doctor.reward import Play, check_reward
from rigid.doctor.scan import check_scan
from rigid.doctor.verdict import Verdict, skipped
from rigid.report.doctor_page import write_doctor_page

HOSTILE = '</h2><script>window.hacked=1</script><img src=x onerror="window.hacked=1">$\\frac'
RNG = np.random.default_rng(0)


def diagnosis(*, feature="angle", protocol=None):
    motion = RNG.normal(size=(10, 20, 2))
    rewards = {kind: RNG.normal(size=(60, 20)) for kind in ("canonical", "passive", "random")}
    ends = [
        End([RNG.normal(mean, 1, 60)], None, [x]) for mean, x in ((0, 1.0), (-99, 0.1), (0, 0.9))
    ]
    naturalness = {0.0: [0.0, 0.1], 1.0: [0.4, 0.5], float("inf"): [0.8, 0.9]}
    verdicts = (
        protocol or Verdict("protocol", "pass", "It does."),
        check_features((feature, "goal"), motion, {"random": 4 * motion}),
        check_reward(Play(rewards, [RNG.normal(-99, 1, 60)])),
        check_data(3, {3: [0.7], 12: [0.9], 25: [0.95]}, source="synthetic"),
        check_ends(*ends),
        check_scan(naturalness, dict.fromkeys(naturalness, 1.0)),
    )
    about = {"task": feature, "robot": "r", "human": "h", "features": "default"}
    return Diagnosis(verdicts, about)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The page of an examination in which one step fails."""
    return write_doctor_page(diagnosis(), tmp_path_factory.mktemp("doctor"))


def test_every_step_has_its_verdict_sentence_and_picture(written, visit):
    with visit(written) as page:
        badges = page.locator("section .badge").all_inner_texts()
        assert badges == ["passes", "passes", "passes", "fails", "passes", "passes"]
        assert page.locator("section svg").count() == 5
        assert page.locator("#data .advice").inner_text().endswith("about 25 would be enough.")
        assert page.locator(".outcome").inner_text() == (
            "Not ready for a frontier: Enough canonical data."
        )
        page.locator(".contents a").nth(3).click()
        assert page.url.endswith("#data")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_words_and_lines_of_pictures_stand_out_from_the_paper(written, visit, scheme):
    with visit(written, color_scheme=scheme) as page:
        paper, text, line = (
            page.evaluate(
                "([what, key]) => getComputedStyle(document.querySelector(what))[key]", [what, key]
            )
            for what, key in (
                ("body", "backgroundColor"), ("#reward svg text", "fill"),
                ("#reward svg [style*='stroke: #000000']", "stroke"),
            )
        )  # fmt: skip
    light = [sum(map(int, colour[4:-1].split(","))) for colour in (paper, text, line)]
    assert (light[0] > 600) == (scheme == "light")
    assert all(abs(light[0] - value) > 200 for value in light[1:])


def test_a_narrow_screen_scrolls_pictures_and_not_the_page(written, visit):
    with visit(written, viewport={"width": 390, "height": 800}) as page:
        assert page.evaluate("document.documentElement.scrollWidth") == 390


def test_words_of_strangers_stay_words(tmp_path, visit):
    broken = Verdict("protocol", "fail", HOSTILE, HOSTILE)
    with visit(write_doctor_page(diagnosis(feature=HOSTILE, protocol=broken), tmp_path)) as page:
        assert page.evaluate("window.hacked") is None
        assert page.locator("script, img").count() == 0
        assert page.locator("#protocol .advice").inner_text() == HOSTILE


def test_a_step_that_was_not_taken_says_so(tmp_path, visit):
    found = diagnosis(protocol=skipped("protocol", "a step before it fails"))
    with visit(write_doctor_page(found, tmp_path)) as page:
        assert page.locator("#protocol p").inner_text() == "Not examined: a step before it fails."
        assert page.locator("#protocol .badge").inner_text() == "not examined"
