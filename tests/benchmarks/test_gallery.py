"""The gallery draws what a run holds, says it in words, and stays small."""

from __future__ import annotations

import re

import pytest
from PIL import Image

from benchmarks import gallery
from tests.report.sample_payload import sample_payload
from tests.report.struck import FRAMES, run_of_strikes


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
    from rigid.tasks.itch_scratching.task import ItchScratching

    task = ItchScratching(ItchScratchingParameters(horizon=FRAMES - 1))
    payload = sample_payload(seeds=1, replays=0)
    return run_of_strikes(tmp_path_factory.mktemp("struck"), task, payload)


@pytest.fixture(scope="module")
def drawn(run, tmp_path_factory):
    out = tmp_path_factory.mktemp("docs")
    assert gallery.main([str(run), "--out", str(out)]) == 0
    return out


def test_the_page_shows_every_picture_that_was_drawn(drawn):
    text = (drawn / "gallery.md").read_text()
    shown = re.findall(r"\]\(gallery/(.+?)\)", text)
    assert sorted(shown) == sorted(path.name for path in (drawn / "gallery").iterdir())
    assert len(shown) > 1
    assert f"python -m benchmarks.gallery {'/'}" in text


def test_pictures_of_an_earlier_gallery_go_and_others_stay(run, tmp_path, monkeypatch):
    monkeypatch.setattr(gallery, "stills_of", lambda _: [])  # Which take their time to draw.
    monkeypatch.setattr(gallery, "keypoints_of", lambda _: Image.new("RGB", (20, 20)))
    pictures = tmp_path / "gallery"
    pictures.mkdir()
    (tmp_path / "gallery.md").write_text("![Somebody](gallery/vanilla-s0-r1-l3.webp)\n")
    for name in ("vanilla-s0-r1-l3.webp", "mine.webp"):
        (pictures / name).write_bytes(b"")
    assert gallery.main([str(run), "--out", str(tmp_path)]) == 0
    drawn_now = f"{run.name}-keypoints.webp"
    assert {path.name for path in pictures.iterdir()} == {drawn_now, "mine.webp"}


def test_a_strike_is_shown_at_its_greatest_force_beside_canonical_motion(drawn):
    text = (drawn / "gallery.md").read_text()
    assert "at its greatest unwanted force" in text
    still = next(p for p in (drawn / "gallery").iterdir() if "keypoints" not in p.name)
    with Image.open(still) as picture:
        assert picture.size == (720, 270)


def test_no_run_is_a_message_and_exit_code_2(capsys):
    assert gallery.main([]) == 2
    assert "name finished run directories, as runs/paper" in capsys.readouterr().err


def test_too_many_pictures_are_refused_and_nothing_is_written(run, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(gallery, "_MOST", 10)
    monkeypatch.setattr(gallery, "stills_of", lambda _: [])  # Which take their time to draw.
    monkeypatch.setattr(gallery, "keypoints_of", lambda _: Image.new("RGB", (20, 20)))
    assert gallery.main([str(run), "--out", str(tmp_path)]) == 2
    assert "bytes of pictures, more than 10: name fewer runs" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
