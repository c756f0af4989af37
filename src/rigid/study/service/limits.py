"""How much one sender may send: token buckets, one for each sender.

Whoever holds a participant's token is measured by that token alone, everybody else by their
address. So nobody uses up what belongs to a participant, not even from the same network.
"""

from __future__ import annotations

import ipaddress
from collections import OrderedDict
from typing import Final, NamedTuple


class Rate(NamedTuple):
    """So many at once, and so many a second from then on."""

    burst: float
    a_second: float


# All ours. A page of the questionnaire asks for three replays at a time; frames of a browser come
# 60 times a second, but targets are sent 30 times at most.
REQUESTS: Final = Rate(120, 20)
"""HTTP requests of a participant."""
CONNECTIONS: Final = Rate(20, 1)
"""Live connections of a participant."""
MESSAGES: Final = Rate(90, 60)
"""Live messages of a participant, of any kind; beyond, the connection is closed."""
TARGETS: Final = Rate(30, 30)
"""Hand targets of a participant; beyond, they have no effect."""
REFUSED: Final = Rate(60, 1)
"""Refused live messages of a participant; beyond, the connection is closed."""
PUBLIC: Final = Rate(400, 40)
"""Requests of an address for what everybody may see; a class may share one address."""
STRANGERS: Final = Rate(60, 2)
"""Requests of an address with a token that nobody has, or with none where one is needed."""

CONNECTED: Final = 400
"""Open connections of an address. Ours: 30 participants behind one address, as those of a class or
of a proxy are, have 7 each (6 of the browser, 1 live) and room to reload."""


class Bucket:
    """Fills up with time, and gives as long as there is something in it."""

    def __init__(self, rate: Rate, now: float) -> None:
        self._rate, self._left, self._then = rate, rate.burst, now

    def take(self, now: float) -> bool:
        """Takes one out; False, and nothing is taken, where it is empty.

        Example:
            >>> bucket = Bucket(Rate(burst=1, a_second=2), now=0.0)
            >>> bucket.take(0.0), bucket.take(0.1), bucket.take(0.6)
            (True, False, True)
        """
        grown = self._left + (now - self._then) * self._rate.a_second
        self._left, self._then = min(self._rate.burst, grown), now
        if self._left < 1:
            return False
        self._left -= 1
        return True


class Buckets:
    """A bucket for each sender; those of whom nothing was heard longest are forgotten."""

    def __init__(self, rate: Rate, *, most: int = 10_000) -> None:
        self._rate, self._most = rate, most
        self._buckets: OrderedDict[str, Bucket] = OrderedDict()

    def take(self, sender: str, now: float) -> bool:
        """As `Bucket.take`, of the sender's own."""
        bucket = self._buckets.get(sender)
        if bucket is None:
            bucket = self._buckets[sender] = Bucket(self._rate, now)
            while len(self._buckets) > self._most:
                self._buckets.popitem(last=False)
        self._buckets.move_to_end(sender)
        return bucket.take(now)


def network(address: str | None) -> str:
    """Whom an address stands for: one IPv6 customer has a whole /64.

    Example:
        >>> network("192.0.2.7"), network("2001:db8::1:2:3:4"), network("::1")
        ('192.0.2.7', '2001:db8::/64', '::/64')
    """
    if address is None:
        return "unknown"
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv4Address):
        return str(found)
    return str(ipaddress.ip_network((found, 64), strict=False))
