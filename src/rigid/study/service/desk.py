"""The store, asked by a thread of its own, so that no frame waits for the disk."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import ParamSpec, TypeVar

_P = ParamSpec("_P")
_Found = TypeVar("_Found")


class Desk:
    """Work done by one thread, in the order in which it was asked for."""

    def __init__(self, name: str) -> None:
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix=name)

    async def do(self, work: Callable[_P, _Found], *args: _P.args, **kwargs: _P.kwargs) -> _Found:
        """What `work` returns. It is done to its end even where nobody waits for it any more."""
        loop = asyncio.get_running_loop()
        asked = loop.run_in_executor(self._thread, partial(work, *args, **kwargs))
        return await asyncio.shield(asked)  # Else it would be dropped while it waits its turn.

    def close(self) -> None:
        """Ends the thread once all is done that was asked for."""
        self._thread.shutdown(wait=True)
