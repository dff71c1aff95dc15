"""Whom an endpoint here exchanges samples with."""

from collections.abc import Callable, Mapping

from navette.transports.base import Endpoint, Item
from navette.transports.expiring import age_ns


class Matches:
    """The remote endpoints that an endpoint here exchanges samples with.

    ``remotes`` (by token), ``by_gid`` (the same), ``sessions`` (of each gid),
    ``asserting`` (gids of those of them that assert themselves) and ``refused`` (gids
    of those whose QoS does not fit) change while others read them.

    Args:
        names: what every publisher or client of others sends on, by gid, also of those
            that are gone.
        asserted: told the gid of a publisher that asserts itself, when it is heard.
    """

    __slots__ = (
        "_asserted",
        "_names",
        "asserting",
        "by_gid",
        "endpoint",
        "refused",
        "remotes",
        "sessions",
        "type_hash",
    )

    def __init__(
        self,
        endpoint: Endpoint,
        type_hash: str,
        names: Mapping[bytes, str],
        asserted: Callable[["Matches", bytes], None],
    ) -> None:
        self._names = names
        self._asserted = asserted
        self.endpoint = endpoint
        self.type_hash = type_hash
        self.remotes: dict[str, Endpoint] = {}
        self.by_gid: dict[bytes, Endpoint] = {}
        self.sessions: dict[bytes, str] = {}
        self.asserting: set[bytes] = set()
        self.refused: set[bytes] = set()

    def add(self, key: str, remote: Endpoint) -> None:
        """One more, by its token."""
        self.remotes[key] = remote
        self.by_gid[remote.gid] = remote
        self.sessions[remote.gid] = key.split("/", 3)[2]
        if remote.qos.asserts_itself:
            self.asserting.add(remote.gid)

    def remove(self, key: str) -> bool:
        """Whether it was one of them."""
        remote = self.remotes.pop(key, None)
        if remote is not None:
            self.by_gid.pop(remote.gid, None)
            self.sessions.pop(remote.gid, None)
            self.asserting.discard(remote.gid)
        return remote is not None

    def clear(self) -> None:
        """There is nobody any more."""
        self.remotes.clear()
        self.by_gid.clear()
        self.sessions.clear()
        self.asserting.clear()

    def astray_from(self, gid: bytes) -> str:
        """The name that the sender sends on, if it is another one; empty otherwise.

        Zenoh sends numbers in place of keys. After a link was lost, a new one may join
        what is left of it at one of its ends; until both are renewed, the ends mean
        different keys by their numbers (decision 0012).
        """
        if gid in self.by_gid:
            return ""
        name = self._names.get(gid, "")
        return "" if name == self.endpoint.topic else name

    def heard(self, gid: bytes, item: Item) -> None:
        """A sample by which its publisher says that it is alive; no old one does."""
        publisher = self.by_gid.get(gid)
        if publisher is None or gid not in self.asserting:
            return
        if age_ns(item) < publisher.qos.lease_ns:
            self._asserted(self, gid)
