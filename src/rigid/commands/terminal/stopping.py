"""What a command says when it is stopped: whether anything is kept, and where."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

ANEW = "nothing was kept yet, so the same command begins anew"


@contextmanager
def goes_on(place: Path, kept: Callable[[], bool] | None = None) -> Iterator[None]:
    """Says of an interrupted command whether it goes on, and does not promise it before it can.

    Args:
        place: Where it keeps what is done.
        kept: Whether there is any; by default, whether there are weights, which checkpoints and
            finished policies have, anywhere in `place`.
    """
    try:
        yield
    except KeyboardInterrupt:
        there = _holds_weights(place) if kept is None else kept()
        raise KeyboardInterrupt(f"the same command goes on in {place}" if there else ANEW) from None


def _holds_weights(place: Path) -> bool:
    return any(place.rglob("*.safetensors"))
