"""Liveliness that a publisher asserts without a message (MANUAL_BY_TOPIC).

rmw_zenoh defines no such sample, so only Navette's subscriptions receive it: a put on
``@navette/<domain>/alive/<gid>``. Wildcards do not match chunks that begin with ``@``.
"""

import threading
from typing import Any

import zenoh

from navette.transports.base import Endpoint, TransportObserver
from navette.transports.zenoh.callbacks import direct
from navette.transports.zenoh.graph import RemoteGraph
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.session_id import is_navette_session


class LivelinessAssertions(TransportObserver):
    """Sends assertions of publishers here, and receives those of remote ones.

    The subscriber is declared when a subscription or publisher first requires it.

    Args:
        graph: receives the assertions, on Zenoh's threads.
    """

    def __init__(
        self, session: zenoh.Session, domain_id: int, graph: RemoteGraph
    ) -> None:
        self._session = session
        self._prefix = f"@navette/{domain_id}/alive"
        self._graph = graph
        self._subscriber: Any = None
        self._lock = threading.Lock()

    def send(self, matches: Matches) -> bool:
        """Assert a publisher; return whether all its subscriptions are Navette's."""
        sessions = {*dict(matches.sessions).values()}
        if sessions:
            self._session.put(
                f"{self._prefix}/{matches.endpoint.gid.hex()}",
                b"",
                congestion_control=zenoh.CongestionControl.DROP,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        return all(map(is_navette_session, sessions))

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        if publisher.is_remote and publisher.qos.asserts_itself:
            self.receive()

    def receive(self) -> None:
        """Receive assertions from now on; may be called again."""
        with self._lock:
            if self._subscriber is None:
                self._subscriber = self._session.declare_subscriber(
                    f"{self._prefix}/*",
                    direct(self._on_sample),
                    allowed_origin=zenoh.Locality.REMOTE,
                )

    def _on_sample(self, sample: zenoh.Sample) -> None:
        gid = str(sample.key_expr).rpartition("/")[2]
        try:
            self._graph.asserted(bytes.fromhex(gid))
        except ValueError:  # not a gid: sent by a program other than Navette
            return
