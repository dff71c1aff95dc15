"""Samples that expire: the lifespan of a publisher's QoS."""

from collections.abc import Callable, Mapping
from typing import Any

from navette.transports.base import Endpoint, Item
from navette.transports.qos import INFINITE_NS

# Stamps that are further apart than this are of clocks that do not belong together:
# one counts from 1970, the other from the beginning of a simulation.
_SAME_CLOCK_NS = 365 * 86_400 * 10**9

# What comes to a new subscription in its first seconds may be a history, and old.
_HISTORY_NS = 2 * 10**9


def age_ns(item: Item) -> int:
    """How old a sample was when it came; 0 where the two clocks do not compare."""
    age = item[2] - item[1]
    return 0 if abs(age) > _SAME_CLOCK_NS else age


class Expiring:
    """In place of the message of a delivered sample: the message, and until when.

    Args:
        message: may be an :class:`~navette.transports.encoded.Encoded`.
        expires_ns: asked when it is taken, where it is not known before.
    """

    __slots__ = ("expires_ns", "message")

    def __init__(self, message: Any, expires_ns: int | Callable[[], int]) -> None:
        self.message = message
        self.expires_ns = expires_ns

    def at(self, now_ns: int) -> Any:
        """The message; None if it is too old by then."""
        until = self.expires_ns
        until_ns = until if isinstance(until, int) else until()
        return self.message if now_ns < until_ns else None


class Lifespans:
    """Limits samples by what their publishers, in other processes, have announced.

    A sample's age is the time here less the time of its sending there, as DDS counts
    it: the machines' clocks are to agree. Where one side's time is a simulation's and
    the other's the machine's, it is as old as it has waited here.

    Args:
        publishers: those that are known by now, by gid; changes meanwhile.
        complain: told of one whose samples are too old when they arrive.
    """

    __slots__ = ("_complain", "_first_ns", "_publishers")

    def __init__(
        self,
        publishers: Mapping[bytes, Endpoint],
        complain: Callable[[Endpoint, str], None],
    ) -> None:
        self._publishers = publishers
        self._complain = complain
        self._first_ns: int | None = None

    def limited(self, gid: bytes, item: Item) -> Item:
        """The sample as it is, or one that expires; any thread."""
        publisher = self._publishers.get(gid)
        lifespan_ns = 0 if publisher is None else publisher.qos.lifespan_ns
        if publisher is not None and not 0 < lifespan_ns < INFINITE_NS:
            return item
        message, source_ns, received_ns, number = item
        since_ns = received_ns - age_ns(item)
        if publisher is None:  # announced already, and known here in a moment
            message = Expiring(message, lambda: since_ns + self._lifespan_of(gid))
        else:
            if received_ns - since_ns >= lifespan_ns:
                self._look_at_age(publisher, since_ns, received_ns)
            message = Expiring(message, since_ns + lifespan_ns)
        return message, source_ns, received_ns, number

    def _look_at_age(self, publisher: Endpoint, since_ns: int, now_ns: int) -> None:
        if self._first_ns is None:
            self._first_ns = now_ns
        if now_ns - self._first_ns >= _HISTORY_NS:
            self._complain(publisher, _too_old(publisher, now_ns - since_ns))

    def _lifespan_of(self, gid: bytes) -> int:
        publisher = self._publishers.get(gid)
        lifespan_ns = 0 if publisher is None else publisher.qos.lifespan_ns
        return lifespan_ns or INFINITE_NS


def _too_old(publisher: Endpoint, old_ns: int) -> str:
    lifespan_s = publisher.qos.lifespan_ns / 1e9
    return (
        f"what {publisher.node_full_name} sends is ignored: it is {old_ns / 1e9:g} s "
        f"old when it comes, and its lifespan is {lifespan_s:g} s; are the clocks of "
        "both machines right?"
    )
