"""Pictures to the bytes of a film: mp4 (H.264), which everything plays, or animated WebP."""

from __future__ import annotations

import importlib.util
import io
from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from rigid.errors import UserError

FORMATS = (".mp4", ".webp")
_QUALITY_MP4 = "20"
"""Constant rate factor of H.264: below 18 the eye sees no difference, 23 is the default. Ours."""
_QUALITY_WEBP, _EFFORT_WEBP = 80, 2
"""Out of 100, Pillow's default; effort of 6, where more costs seconds and saves little. Ours."""


def check_format(path: Path, width: int, height: int) -> None:
    """Refuses a film that cannot be written, before any picture is drawn.

    Raises:
        UserError: Another file ending than .mp4 or .webp; an odd size or no encoder for .mp4.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise UserError(f"--video {path}: films end in .mp4 or .webp, not in {suffix or 'nothing'}")
    if suffix == ".webp":
        return
    if importlib.util.find_spec("av") is None:
        raise UserError(
            "mp4 needs the extra `video`: pip install 'rigid-frontier[video]'; .webp needs nothing"
        )
    if width % 2 or height % 2:
        raise UserError(f"--size {width}x{height}: mp4 needs an even width and an even height")


def encode(frames: Iterable[UInt8[np.ndarray, "h w 3"]], suffix: str, fps: int) -> bytes:
    """A film of equal pictures as the bytes of a file.

    Args:
        frames: One or more; WebP keeps them all in memory.
        suffix: Of the file, one of `FORMATS`.
        fps: Pictures per second.
    """
    return _mp4(frames, fps) if suffix.lower() == ".mp4" else _webp(frames, fps)


def _mp4(frames: Iterable[UInt8[np.ndarray, "h w 3"]], fps: int) -> bytes:
    import av

    stored = io.BytesIO()
    with av.open(stored, "w", format="mp4") as container:
        stream = None
        for picture in frames:
            if stream is None:
                stream = container.add_stream("libx264", rate=Fraction(fps))
                stream.height, stream.width = picture.shape[:2]
                stream.pix_fmt = "yuv420p"  # The only one that every player knows.
                stream.options = {"crf": _QUALITY_MP4}
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
            container.mux(stream.encode(frame))
        if stream is not None:
            container.mux(stream.encode())
    return stored.getvalue()


def _webp(frames: Iterable[UInt8[np.ndarray, "h w 3"]], fps: int) -> bytes:
    first, *others = (Image.fromarray(frame) for frame in frames)
    # Whole milliseconds that add up to the right time.
    ends = [round(1000 * number / fps) for number in range(len(others) + 2)]
    stored = io.BytesIO()
    first.save(
        stored, "WEBP", save_all=True, append_images=others, loop=0, quality=_QUALITY_WEBP,
        method=_EFFORT_WEBP, duration=[after - before for before, after in pairwise(ends)],
    )  # fmt: skip
    return stored.getvalue()
