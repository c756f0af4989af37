"""Being told to end by whoever started a process, which is to be as good an end as Ctrl-C."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

_PATIENCE = 1.0  # Seconds that other threads have to end, before the process ends without them.


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


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Keeps interrupts until the end of the block, for what must not stay half done.

    On other threads, which nothing interrupts, it changes nothing.

    Raises:
        KeyboardInterrupt: A signal that means it came within the block.
    """
    held: list[int] = []
    if threading.current_thread() is threading.main_thread():
        signals = (signal.SIGINT, signal.SIGTERM)
        held = [one for one in signals if signal.getsignal(one) is signal.default_int_handler]
    came: list[int] = []
    try:
        for one in held:
            signal.signal(one, lambda number, _: came.append(number))
        yield
    finally:
        for one in held:
            signal.signal(one, signal.default_int_handler)
        if came:
            raise KeyboardInterrupt


def give_back_semaphores() -> None:
    """Gives the system those of worker processes back, before a process ends without cleaning up.

    Otherwise a helper process of `loky` does, and complains.
    """
    if util := sys.modules.get("multiprocessing.util"):
        deadline = time.monotonic() + _PATIENCE
        for thread in set(threading.enumerate()) - {threading.current_thread()}:
            thread.join(max(0.0, deadline - time.monotonic()))  # It may be giving some back itself.
        # Only the end of the interpreter calls it, and that is where libraries would crash.
        util._run_finalizers(0)  # noqa: SLF001 - No public function gives semaphores back.
