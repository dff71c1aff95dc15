"""Liveliness tokens of closed endpoints, reused for new endpoints of the same kind."""

import threading

from navette.transports.zenoh.tokens import EndpointToken

# Beyond that a new endpoint gets a new token, as the first one of its kind does.
_MAX_TOKENS = 10_000


class TokenPool:
    """Gives an endpoint the token of a closed one with the same node, topic and QoS.

    Zenoh remembers each key that was ever declared on a link, about 9 kB for a token,
    until the link ends (decision 0018). A node that opens a client for every call would
    fill the memory. With the token goes the gid, by which other sessions know the last
    sequence number; numbering therefore continues.
    """

    def __init__(self) -> None:
        self._free: dict[EndpointToken, list[tuple[int, int]]] = {}
        self._count = 0
        self._lock = threading.Lock()

    def put(self, token: EndpointToken, last_sequence: int) -> None:
        """Return the token of a closed endpoint, with its last sequence number."""
        with self._lock:
            if self._count < _MAX_TOKENS:
                self._count += 1
                kind = token._replace(eid=0)
                self._free.setdefault(kind, []).append((token.eid, last_sequence))

    def take(self, token: EndpointToken) -> tuple[EndpointToken, int]:
        """Return a free token like this one, or this one, and its last number."""
        kind = token._replace(eid=0)
        with self._lock:
            free = self._free.get(kind)
            if not free:
                return token, 0
            self._count -= 1
            eid, last_sequence = free.pop()
            if not free:
                del self._free[kind]
        return token._replace(eid=eid), last_sequence
