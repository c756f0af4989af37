"""Films can be played again: as many pictures, as large, as long, and of the same colours."""

from __future__ import annotations

import importlib.util
import io
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from rigid.errors import UserError
from rigid.report.encode import check_format, encode

COLOURS = ((200, 30, 30), (30, 200, 30), (30, 30, 200), (120, 120, 120))
SIZE = (48, 32)


def pictures(count=4):
    width, height = SIZE
    for number in range(count):
        yield np.full((height, width, 3), COLOURS[number % 4], np.uint8)


def decoded_mp4(data):
    with av.open(io.BytesIO(data)) as container:
        stream = container.streams.video[0]
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(stream)]
        return frames, float(stream.average_rate), stream.codec_context.name


def decoded_webp(data):
    image, frames, durations = Image.open(io.BytesIO(data)), [], []
    for number in range(image.n_frames):
        image.seek(number)
        frames.append(np.asarray(image.convert("RGB")))
        durations.append(image.info["duration"])
    return frames, durations


def test_an_mp4_holds_every_picture_at_its_pace():
    frames, rate, codec = decoded_mp4(encode(pictures(), ".mp4", fps=12))
    assert (len(frames), rate, codec) == (4, 12.0, "h264")
    for frame, colour in zip(frames, COLOURS, strict=True):
        assert frame.shape == (SIZE[1], SIZE[0], 3)
        np.testing.assert_allclose(frame.mean(axis=(0, 1)), colour, atol=12)


def test_a_webp_holds_every_picture_and_lasts_as_long_as_it_should():
    frames, durations = decoded_webp(encode(pictures(30), ".webp", fps=30))
    assert len(frames) == 30
    assert sum(durations) == 1000  # [ms]
    assert set(durations) == {33, 34}
    for frame, colour in zip(frames, COLOURS, strict=False):
        assert frame.shape == (SIZE[1], SIZE[0], 3)
        np.testing.assert_allclose(frame.mean(axis=(0, 1)), colour, atol=12)


def test_a_film_of_one_picture_is_a_picture():
    frames, _, _ = decoded_mp4(encode(pictures(1), ".mp4", fps=30))
    assert len(frames) == 1
    image = Image.open(io.BytesIO(encode(pictures(1), ".WEBP", fps=30)))
    assert image.size == SIZE


@pytest.mark.parametrize(
    ("name", "ending"), [("film.gif", r"\.gif"), ("film", "nothing"), ("a.mp4.mov", r"\.mov")]
)
def test_other_endings_are_refused(name, ending):
    with pytest.raises(UserError, match=f"films end in .mp4 or .webp, not in {ending}$"):
        check_format(Path(name), 800, 600)


@pytest.mark.parametrize("size", [(801, 600), (800, 601)])
def test_an_mp4_of_odd_size_is_refused_and_a_webp_is_not(size):
    check_format(Path("film.webp"), *size)
    with pytest.raises(UserError, match=f"--size {size[0]}x{size[1]}: mp4 needs an even width"):
        check_format(Path("film.MP4"), *size)


def test_without_the_extra_the_message_says_how_to_get_it(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    check_format(Path("film.webp"), 800, 600)
    with pytest.raises(UserError, match=r"pip install 'rigid-frontier\[video\]'"):
        check_format(Path("film.mp4"), 800, 600)
