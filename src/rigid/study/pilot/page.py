"""What the page of one participant asks of the server."""

from __future__ import annotations

import asyncio
import http.client
import json
import re
from collections.abc import Mapping
from contextlib import closing
from typing import Any
from urllib.parse import urlsplit

from rigid.errors import UserError

_TIMEOUT = 60.0
"""[s]; nothing that a page asks for takes so long."""


class Page:
    """Asks below /p/TOKEN, one request at a time."""

    def __init__(self, address: str, path: str) -> None:
        """Asks nothing yet.

        Args:
            address: The server's.
            path: Of the participant's link, such as /p/TOKEN.
        """
        self._address, self._path = address, path

    @property
    def live(self) -> str:
        """Address of the live connection."""
        return f"ws://{urlsplit(self._address).netloc}{self._path}/live"

    async def open(self) -> None:
        """Loads what a browser loads: the page, its front end, its words and the scene.

        Raises:
            UserError: Something of it is refused.
        """
        for path in (self._path, "/static/study.js", "/static/study.css"):
            await asyncio.to_thread(asked, self._address, path)
        for name in ("texts", "scene"):
            await self.get(name)

    async def get(self, name: str) -> Any:
        """What `/api/NAME` answers."""
        path = f"{self._path}/api/{name}"
        return json.loads(await asyncio.to_thread(asked, self._address, path))

    async def post(self, name: str, message: Mapping[str, Any]) -> Any:
        """The state after `/api/NAME` took a message."""
        path = f"{self._path}/api/{name}"
        return json.loads(await asyncio.to_thread(asked, self._address, path, message))


def asked(
    address: str,
    path: str,
    message: Mapping[str, Any] | None = None,
    headers: Mapping[str, str] | None = None,
) -> bytes:
    """What a server answers.

    Args:
        address: The server's, with HTTP.
        path: Of what is asked for.
        message: Sent as JSON; None: only asked.
        headers: Besides those of JSON.

    Raises:
        UserError: The server refuses, or is gone.
    """
    place = urlsplit(address)
    assert place.hostname is not None
    method = "GET" if message is None else "POST"
    name = re.sub("^/p/[^/]+", "/p/…", path)  # Tokens are not for terminals.
    body = None if message is None else json.dumps(message)
    kind = {} if message is None else {"Content-Type": "application/json"}
    connection = http.client.HTTPConnection(place.hostname, place.port, timeout=_TIMEOUT)
    with closing(connection):
        try:
            connection.request(method, path, body, {**kind, **(headers or {})})
            response = connection.getresponse()
            answer = response.read()
        except (OSError, http.client.HTTPException) as error:
            raise UserError(f"{method} {name} failed: {error}") from None
    if response.status != http.client.OK:
        said = answer.decode(errors="replace")[:200]
        raise UserError(f"{method} {name} was refused with {response.status}: {said}")
    return answer
