"""The page as a file: what it embeds, escapes, replaces and refuses."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.report import build, build_report, encode_poses
from rigid.report.build import embed_json, render_page


def payload_of(page: str) -> dict:
    """What the browser's JSON.parse gets."""
    text = re.search(r'<script type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert text
    return json.loads(text[1])


def page_of(payload, script="let a = 1;", style="p{}"):
    return render_page(payload, script=script, style=style)


@pytest.mark.parametrize(
    "text",
    ["</script>", "<!--", "&amp;", "\u2028\u2029", "\ud800", "λ = ∞", "\\u003c", '"', "$payload"],
)
def test_any_text_comes_back_unchanged_and_without_markup(text):
    embedded = embed_json({text: [text]})
    assert json.loads(embedded) == {text: [text]}
    assert not set("<>&\u2028\u2029").intersection(embedded)
    assert payload_of(page_of({"stamp": text})) == {"stamp": text}


def test_numbers_that_are_not_finite_become_null():
    assert embed_json([np.nan, float("inf"), np.float64(0.5), np.int64(3)]) == "[null,null,0.5,3]"


def test_arrays_become_lists():
    assert embed_json({"x": np.array([[1.0, np.nan]])}) == '{"x":[[1.0,null]]}'


def test_frontier_keeps_every_digit_and_replays_only_those_that_are_drawn():
    payload = {"frontier": {"auc": 0.123456789012}, "replays": {"a": {"force": [0.123456789012]}}}
    embedded = payload_of(page_of(payload))
    assert embedded["frontier"]["auc"] == 0.123456789012
    assert embedded["replays"]["a"]["force"] == [0.12346]


def test_title_cannot_close_its_element():
    page = page_of({"frontier": {"robot": "</title><script>", "task": "\ud800"}})
    assert "<title>&lt;/title&gt;&lt;script&gt; on &#55296; &#183; RIGID</title>" in page


def test_only_the_bundled_script_may_run():
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page_of({}))
    assert policy
    assert "default-src 'none'" in policy[1]
    assert re.search(r"script-src 'sha256-[A-Za-z0-9+/]{43}='", policy[1])


@pytest.mark.parametrize("bundle", [{"script": "a='</SCRIPT>'"}, {"style": "</style>"}])
def test_bundle_that_would_end_its_element_is_refused(bundle):
    with pytest.raises(ValueError, match="would end its element"):
        page_of({}, **bundle)


def test_missing_bundle_names_its_cure(monkeypatch, tmp_path):
    monkeypatch.setattr(build, "_PACKAGE", tmp_path)
    with pytest.raises(UserError, match=r"report\.js is missing.*npm --prefix web run build"):
        build_report({}, tmp_path / "report.html")


def test_report_replaces_the_old_one_and_leaves_nothing_beside_it(tmp_path):
    out = tmp_path / "new" / "report.html"
    build_report({"stamp": "first"}, out)
    assert build_report({"stamp": "second"}, out) == out
    assert payload_of(out.read_text(encoding="utf-8")) == {"stamp": "second"}
    assert [path.name for path in out.parent.iterdir()] == ["report.html"]


def test_unwritable_place_is_a_users_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(
        UserError, match=r"cannot write the report .*file/report\.html \(.*\): choose ano"
    ):
        build_report({}, tmp_path / "file" / "report.html")


def test_report_names_no_other_host(report):
    page = report.read_text(encoding="utf-8")
    assert not re.search(r"<(?:link|img|iframe|script)[^>]+(?:src|href)=", page)
    assert not re.search(r"@import|url\((?!['\"]?(?:data:|#))", page[: page.index("</style>")])


def test_54_points_with_two_motions_each_stay_under_15_megabytes(payload, tmp_path):
    """With 40 moving bodies, three times what the arm and the person have here."""
    motions = [m for m in payload["replays"].values() if "worst" in m]
    clip = motions[0]["worst"]
    poses = np.zeros((clip["frames"], 40, 7)) + [0, 0, 0, 1, 0, 0, 0]
    heavy = {**clip, "poses": encode_poses(poses), "bodies": list(range(40))}
    stored = {"canonical": dict.fromkeys(map(str, range(25)), heavy)}
    stored |= {p: {"worst": heavy, "median": heavy} for p in map(str, range(54))}
    size = build_report({**payload, "replays": stored}, tmp_path / "report.html").stat().st_size
    assert size < 15e6
