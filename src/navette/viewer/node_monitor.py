"""Periodic check of all nodes while a client displays their state.

The socket thread triggers the check: its timer keeps running while a callback of this
program blocks, and it measures wall time whatever clock the program uses.
"""

from navette.viewer.graph_access import GraphAccess
from navette.viewer.liveness import LivenessProbe, NodeReport
from navette.viewer.node_reports import NodeReports
from navette.viewer.remote_parameters import RemoteParameters
from navette.viewer.service_calls import ServiceCalls
from navette.viewer.thread_bridge import ThreadBridge
from navette.viewer.topic_ends import is_hidden
from navette.viewer.wall_clock import WallClock

_BLOCKED_S = 2.0  # without an executor turn: then all nodes of this program are blocked


class NodeMonitor:
    """Probes the nodes and reports their states to the clients."""

    def __init__(
        self,
        reports: NodeReports,
        *,
        bridge: ThreadBridge,
        graph: GraphAccess,
        service_calls: ServiceCalls,
        remote: RemoteParameters,
        clock: WallClock,
    ) -> None:
        self._reports = reports
        self._bridge = bridge
        self._graph = graph
        self._service_calls = service_calls
        self._remote = remote
        self._probe = LivenessProbe(service_calls, clock)
        self._clock = clock
        self._newest: list[NodeReport] = []
        self._is_scheduled = False
        self._scheduled_s = 0.0
        self._is_active = False  # the probe has state to reset

    def on_period(self) -> None:
        """Check once; the socket thread calls this every ``liveness.PERIOD_S``."""
        if self._is_scheduled:
            waited_s = self._clock.now_s - self._scheduled_s
            if waited_s > _BLOCKED_S:
                self._reports.set_nodes(self._newest, waited_s)
        elif self._reports.are_wanted or self._is_active or self._service_calls.pending:
            self._is_scheduled, self._scheduled_s = True, self._clock.now_s
            self._bridge.run_soon(self._check, "node monitor")

    def _check(self) -> None:
        self._is_scheduled = False
        self._service_calls.expire()
        self._is_active = self._reports.are_wanted
        if not self._is_active:
            self._probe.reset()
            return
        self._remote.fetch()
        here = {node.get_fully_qualified_name() for node in self._graph.local_nodes()}
        others = self._graph.node_names() - here
        self._newest = self._probe.step(
            {name for name in here if not is_hidden(name)},
            {name: self._remote.serves(name) for name in others if not is_hidden(name)},
        )
        self._bridge.call_hub(self._reports.set_nodes, self._newest, 0.0)
