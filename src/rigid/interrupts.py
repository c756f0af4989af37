"""Being told to end by whoever started a process, which is to be as good an end as Ctrl-C."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def terminated_as_interrupted() -> Iterator[None]:
    """Lets SIGTERM, as of a scheduler or `timeout`, raise `KeyboardInterrupt` within the block.

    Only the main thread may enter it.
    """
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
