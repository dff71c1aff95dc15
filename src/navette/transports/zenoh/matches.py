"""The remote endpoints that a local endpoint exchanges samples with."""

from collections.abc import Callable, Mapping

from navette.transports.base import Endpoint, Item
from navette.transports.expiring import age_ns
from navette.transports.qos import INFINITE_NS

OnAsserted = Callable[["Matches", bytes], None]
"""Called with the gid of a publisher whose sample asserts that it is alive."""


class Matches:
    """Remote endpoints matched with a local one; changed while other threads read.

    Args:
        endpoint: the local endpoint.
        topics: gid → topic of every remote publisher or client ever seen.

    Attributes:
        remotes: matched endpoints by liveliness token.
        by_gid: the same by gid.
        sessions: gid → session.
        asserting: gids of matched publishers with liveliness MANUAL_BY_TOPIC.
        limited: gids of matched publishers whose samples expire.
        refused: gids of publishers whose QoS is incompatible.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        type_hash: str,
        topics: Mapping[bytes, str],
        *,
        on_asserted: OnAsserted,
    ) -> None:
        self._topics = topics
        self._on_asserted = on_asserted
        self.endpoint = endpoint
        self.type_hash = type_hash
        self.remotes: dict[str, Endpoint] = {}
        self.by_gid: dict[bytes, Endpoint] = {}
        self.sessions: dict[bytes, str] = {}
        self.asserting: set[bytes] = set()
        self.limited: set[bytes] = set()
        self.refused: set[bytes] = set()

    def add(self, key: str, remote: Endpoint) -> None:
        self.remotes[key] = remote
        self.by_gid[remote.gid] = remote
        self.sessions[remote.gid] = key.split("/", 3)[2]
        if remote.qos.asserts_itself:
            self.asserting.add(remote.gid)
        if 0 < remote.qos.lifespan_ns < INFINITE_NS:
            self.limited.add(remote.gid)

    def remove(self, key: str) -> bool:
        """Remove the endpoint of a token; return whether it was matched."""
        remote = self.remotes.pop(key, None)
        if remote is not None:
            self.by_gid.pop(remote.gid, None)
            self.sessions.pop(remote.gid, None)
            self.asserting.discard(remote.gid)
            self.limited.discard(remote.gid)
        return remote is not None

    def clear(self) -> None:
        self.remotes.clear()
        self.by_gid.clear()
        self.sessions.clear()
        self.asserting.clear()
        self.limited.clear()

    def publisher_of_other_topic(self, gid: bytes) -> str:
        """Return the topic of the gid's publisher if it is another one; else "".

        Zenoh sends numbers in place of keys. After a link was lost, a new link may join
        the rest of the old one at one end; until both ends are renewed they mean
        different keys by the same number (decision 0012).
        """
        if gid in self.by_gid:
            return ""
        topic = self._topics.get(gid, "")
        return "" if topic == self.endpoint.topic else topic

    def publishers(self) -> dict[bytes, Endpoint]:
        """Return a copy of :attr:`by_gid`."""
        return dict(self.by_gid)

    def on_sample(self, gid: bytes, item: Item) -> None:
        """Assert the publisher of a sample that is not older than its lease."""
        publisher = self.by_gid.get(gid)
        if publisher is None or gid not in self.asserting:
            return
        if age_ns(item) < publisher.qos.lease_ns:
            self._on_asserted(self, gid)
