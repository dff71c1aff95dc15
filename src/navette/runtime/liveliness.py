"""Who is alive: leases that publishers keep, and what subscriptions see of it.

A publisher that asserts itself (MANUAL_BY_TOPIC) is alive for its lease after each
message or assertion; every other one for as long as it is there. The lease of one in
another process is kept by the subscriptions here that hear it, with its messages: an
assertion without a message does not go over the network (rmw_zenoh has no place for
it).
"""

import threading
from collections.abc import Callable

from navette.runtime.deadlines import Watchdog
from navette.runtime.graph import Graph
from navette.runtime.loop import EventLoop
from navette.runtime.qos_events import QoSCountInfo, QoSLivelinessChangedInfo
from navette.transports import Endpoint


class Lease:
    """A publisher's: tells the graph when it lapses and when it is taken up again.

    Args:
        lost: told when it lapses; for a publisher of another process nobody.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        graph: Graph,
        loop: EventLoop,
        lost: Callable[[QoSCountInfo], None] | None = None,
    ) -> None:
        self._endpoint = endpoint
        self._graph = graph
        self._clock = loop.clock
        self._until_ns = 0
        # Renewed in any thread, lapses in the loop's.
        self._lock = threading.Lock()
        self._lost = lost
        self._count = 0
        self._is_alive = False
        self._dog = Watchdog(
            endpoint.qos.lease_ns, self._lapse, loop, endpoint.node_full_name
        )

    def renew(self) -> None:
        """A message or an assertion."""
        with self._lock:
            self._until_ns = self._clock.now_ns + self._endpoint.qos.lease_ns
            if not self._is_alive:
                self._is_alive = True
                self._graph.report_liveliness(self._endpoint, alive=True)
            self._dog.restart()

    def stop(self) -> None:
        """The publisher goes."""
        with self._lock:
            self._dog.stop()
            self._graph.manually_alive.discard(self._endpoint.gid)

    def _lapse(self) -> None:
        with self._lock:
            if self._clock.now_ns < self._until_ns:  # renewed just now
                return
            self._dog.stop()
            self._is_alive = False
            self._count += 1
            self._graph.report_liveliness(self._endpoint, alive=False)
            if self._lost is not None:
                self._lost(QoSCountInfo(self._count, 1))


class LivelinessView:
    """A subscription's: which of its publishers are alive."""

    def __init__(
        self, graph: Graph, changed: Callable[[QoSLivelinessChangedInfo], None]
    ) -> None:
        self._graph = graph
        self._changed = changed
        self._alive: set[bytes] = set()
        self._lapsed: set[bytes] = set()
        self._matched: set[bytes] = set()

    def on_match(self, publisher: Endpoint, up: bool) -> None:
        gid = publisher.gid
        if not up:
            self._matched.discard(gid)
            self._move(gid, alive=False, lapsed=False)
            return
        self._matched.add(gid)
        if not publisher.qos.asserts_itself or gid in self._graph.manually_alive:
            self._move(gid, alive=True, lapsed=False)

    def on_liveliness(self, publisher: Endpoint, alive: bool) -> None:
        if publisher.gid in self._matched:
            self._move(publisher.gid, alive=alive, lapsed=not alive)

    def _move(self, gid: bytes, *, alive: bool, lapsed: bool) -> None:
        before = len(self._alive), len(self._lapsed)
        for members, belongs in ((self._alive, alive), (self._lapsed, lapsed)):
            (members.add if belongs else members.discard)(gid)
        info = QoSLivelinessChangedInfo(
            alive_count=len(self._alive),
            not_alive_count=len(self._lapsed),
            alive_count_change=len(self._alive) - before[0],
            not_alive_count_change=len(self._lapsed) - before[1],
        )
        if info.alive_count_change or info.not_alive_count_change:
            self._changed(info)
