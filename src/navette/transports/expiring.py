"""Samples that expire: the lifespan of a publisher's QoS."""

from collections.abc import Callable, Mapping
from typing import Any

from navette.transports.base import Endpoint, Item
from navette.transports.qos import INFINITE_NS

# Stamps further apart than this are of different clocks: one counts from 1970, the
# other from the beginning of a simulation.
_SAME_CLOCK_NS = 365 * 86_400 * 10**9

# Samples that a new subscription receives in its first seconds may be history, and old.
_HISTORY_NS = 2 * 10**9


def age_ns(item: Item) -> int:
    """Return the age of a sample on arrival; 0 if its two clocks do not compare."""
    age = item[2] - item[1]
    return 0 if abs(age) > _SAME_CLOCK_NS else age


LateExpiry = Callable[[], int]
"""Returns the expiry in ns when the sample is taken: until then it may be unknown."""

OnExpired = Callable[[Endpoint, str], None]
"""Called with a publisher whose samples have expired on arrival, and the warning."""


class Expiring:
    """A message with its expiry, in place of the message of a delivered sample.

    Args:
        message: may be an :class:`~navette.transports.encoded.Encoded`.
    """

    __slots__ = ("expires_ns", "message")

    def __init__(self, message: Any, expires_ns: int | LateExpiry) -> None:
        self.message = message
        self.expires_ns = expires_ns

    def at(self, now_ns: int) -> Any:
        """Return the message; None if it has expired by then."""
        until = self.expires_ns
        until_ns = until if isinstance(until, int) else until()
        return self.message if now_ns < until_ns else None


class Lifespans:
    """Applies the announced lifespans of remote publishers to their samples.

    The age of a sample is the time here minus the time of sending there, as in DDS: the
    clocks of the machines must agree. If one of the two is simulated time, the age is
    the time since the sample arrived.

    Args:
        publishers: the known publishers by gid; changes meanwhile.
    """

    def __init__(
        self, publishers: Mapping[bytes, Endpoint], *, on_expired: OnExpired
    ) -> None:
        self._publishers = publishers
        self._on_expired = on_expired
        self._first_ns: int | None = None

    def limited(self, gid: bytes, item: Item) -> Item:
        """Return the sample, with an expiry if it has one; called from any thread."""
        publisher = self._publishers.get(gid)
        lifespan_ns = 0 if publisher is None else publisher.qos.lifespan_ns
        if publisher is not None and not 0 < lifespan_ns < INFINITE_NS:
            return item
        message, source_ns, received_ns, number = item
        since_ns = received_ns - age_ns(item)
        if publisher is None:  # its token has not been read yet
            message = Expiring(message, lambda: since_ns + self._lifespan_of(gid))
        else:
            if received_ns - since_ns >= lifespan_ns:
                self._warn_if_live(publisher, since_ns, received_ns)
            message = Expiring(message, since_ns + lifespan_ns)
        return message, source_ns, received_ns, number

    def _warn_if_live(self, publisher: Endpoint, since_ns: int, now_ns: int) -> None:
        if self._first_ns is None:
            self._first_ns = now_ns
        if now_ns - self._first_ns >= _HISTORY_NS:
            self._on_expired(publisher, _expired(publisher, now_ns - since_ns))

    def _lifespan_of(self, gid: bytes) -> int:
        publisher = self._publishers.get(gid)
        lifespan_ns = 0 if publisher is None else publisher.qos.lifespan_ns
        return lifespan_ns or INFINITE_NS


def _expired(publisher: Endpoint, old_ns: int) -> str:
    lifespan_s = publisher.qos.lifespan_ns / 1e9
    return (
        f"messages of {publisher.node_full_name} are dropped: they are "
        f"{old_ns / 1e9:g} s old on arrival, longer than their lifespan of "
        f"{lifespan_s:g} s; check that the clocks of both machines agree"
    )
