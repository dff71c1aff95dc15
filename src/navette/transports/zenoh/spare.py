"""Names on the network that endpoints have left, for those that come after them."""

import threading

from navette.transports.zenoh.tokens import EndpointToken

# Kept at most; beyond that an endpoint gets a new name, as the first of its kind does.
_MOST = 10_000


class SpareTokens:
    """Gives an endpoint the token of one of the very same kind that is gone.

    Zenoh remembers each key that was ever declared on a link, some 9 kB in all for a
    token, until the link ends (decision 0018): a node that opens a client for every
    call would fill the memory. With the token goes the gid, under which others know
    how far its numbers have come; so numbers go on where they were.
    """

    def __init__(self) -> None:
        self._spare: dict[EndpointToken, list[tuple[int, int]]] = {}
        self._count = 0
        self._lock = threading.Lock()

    def put(self, token: EndpointToken, used: int) -> None:
        """An endpoint is gone; ``used``: the last number that it has sent."""
        with self._lock:
            if self._count < _MOST:
                self._count += 1
                kind = token._replace(eid=0)
                self._spare.setdefault(kind, []).append((token.eid, used))

    def take(self, token: EndpointToken) -> tuple[EndpointToken, int]:
        """One of that kind, whatever its ``eid``, and the last number used under it."""
        kind = token._replace(eid=0)
        with self._lock:
            found = self._spare.get(kind)
            if not found:
                return token, 0
            self._count -= 1
            eid, used = found.pop()
            if not found:
                del self._spare[kind]
        return token._replace(eid=eid), used
