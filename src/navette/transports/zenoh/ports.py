"""What the publishers, subscriptions, servers and clients of a session share."""

from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple, Protocol

from navette.transports.clock import NanosecondClock
from navette.transports.qos import EndpointQos
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.session import ZenohSession


class ZenohEntity(NamedTuple):
    """Identity of one local endpoint on the network.

    Attributes:
        matches: the remote endpoints that it exchanges samples with.
        key: key expression of its samples or requests.
        gid: hash of its liveliness token.
        qos: the QoS in its liveliness token.
        initial_sequence: last sequence number sent under this gid by an earlier
            endpoint; numbering continues after it.
    """

    matches: Matches
    key: str
    gid: bytes
    qos: EndpointQos
    initial_sequence: int


class PortOwner(Protocol):
    """The transport, as its ports see it."""

    @property
    def session(self) -> ZenohSession:
        """The session with the network."""

    @property
    def own_gids(self) -> AbstractSet[bytes]:
        """Gids of this session's publishers."""

    @property
    def clock(self) -> NanosecondClock:
        """The time for received stamps and replies."""

    def release(self, port: Any) -> None:
        """Withdraw the endpoint of a port that closes."""

    def assert_liveliness(self, matches: Matches) -> bool:
        """Announce that a publisher is alive; see ``PublisherPort.assert_alive``."""
