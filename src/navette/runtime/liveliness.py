"""Liveliness: leases of publishers, and the alive publishers of a subscription.

A publisher with manual liveliness (MANUAL_BY_TOPIC) is alive for its lease duration
after each message or assertion; any other publisher is alive while it exists. The
lease of a publisher in another process is tracked by the local subscriptions that
receive its messages: rmw_zenoh has no assertion without a message.
"""

import threading
from collections.abc import Callable

from navette.runtime.deadlines import Watchdog
from navette.runtime.graph import Graph
from navette.runtime.loop import EventLoop
from navette.runtime.qos_events import QoSCountInfo, QoSLivelinessChangedInfo
from navette.transports import Endpoint

OnLost = Callable[[QoSCountInfo], None]
"""Called when a publisher's lease expires."""

OnLivelinessChanged = Callable[[QoSLivelinessChangedInfo], None]
"""Called when the alive publishers of a subscription change."""


class Lease:
    """Lease of a publisher; reports its expiry and renewal to the graph.

    Args:
        on_lost: None for a publisher of another process.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        graph: Graph,
        loop: EventLoop,
        *,
        on_lost: OnLost | None = None,
    ) -> None:
        self._endpoint = endpoint
        self._graph = graph
        self._clock = loop.clock
        self._until_ns = 0
        # Renewed in any thread, expires in the loop's thread.
        self._lock = threading.Lock()
        self._on_lost = on_lost
        self._count = 0
        self._is_alive = False
        self._watchdog = Watchdog(
            endpoint.qos.lease_ns,
            loop,
            endpoint.node_full_name,
            on_expiry=self._expire,
        )

    def renew(self) -> None:
        """Renew the lease after a message or an assertion."""
        with self._lock:
            self._until_ns = self._clock.now_ns + self._endpoint.qos.lease_ns
            if not self._is_alive:
                self._is_alive = True
                self._graph.report_liveliness(self._endpoint, alive=True)
            self._watchdog.restart()

    def stop(self) -> None:
        """End the lease; the publisher was destroyed."""
        with self._lock:
            self._watchdog.stop()
            self._graph.manually_alive.discard(self._endpoint.gid)

    def _expire(self) -> None:
        with self._lock:
            if self._clock.now_ns < self._until_ns:  # renewed meanwhile
                return
            self._watchdog.stop()
            self._is_alive = False
            self._count += 1
            self._graph.report_liveliness(self._endpoint, alive=False)
            if self._on_lost is not None:
                self._on_lost(QoSCountInfo(self._count, 1))


class LivelinessView:
    """Alive and expired publishers of one subscription."""

    def __init__(self, graph: Graph, *, on_change: OnLivelinessChanged) -> None:
        self._graph = graph
        self._on_change = on_change
        self._alive: set[bytes] = set()
        self._not_alive: set[bytes] = set()
        self._matched: set[bytes] = set()

    def on_match(self, publisher: Endpoint, up: bool) -> None:
        gid = publisher.gid
        if not up:
            self._matched.discard(gid)
            self._move(gid, alive=False, expired=False)
            return
        self._matched.add(gid)
        if not publisher.qos.asserts_itself or gid in self._graph.manually_alive:
            self._move(gid, alive=True, expired=False)

    def on_liveliness(self, publisher: Endpoint, alive: bool) -> None:
        if publisher.gid in self._matched:
            self._move(publisher.gid, alive=alive, expired=not alive)

    def _move(self, gid: bytes, *, alive: bool, expired: bool) -> None:
        before = len(self._alive), len(self._not_alive)
        for members, belongs in ((self._alive, alive), (self._not_alive, expired)):
            (members.add if belongs else members.discard)(gid)
        info = QoSLivelinessChangedInfo(
            alive_count=len(self._alive),
            not_alive_count=len(self._not_alive),
            alive_count_change=len(self._alive) - before[0],
            not_alive_count_change=len(self._not_alive) - before[1],
        )
        if info.alive_count_change or info.not_alive_count_change:
            self._on_change(info)
