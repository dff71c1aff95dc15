"""Periodic check of all nodes while a client displays their state.

The socket thread triggers the check: its timer keeps running while a callback of this
program blocks, and it measures wall time whatever clock the program uses.
"""

from collections.abc import Callable, Mapping

from navette.viewer.hub import Hub
from navette.viewer.liveness import LivenessProbe, NodeReport
from navette.viewer.parameter_requests import Call
from navette.viewer.remote_parameters import RemoteParameters
from navette.viewer.service_calls import ServiceCalls

_BLOCKED_S = 2.0  # without an executor turn: then all nodes of this program are blocked

RunSoon = Callable[[Callable[[], None], str], None]
"""Schedules a function on the executor's thread, with a name for it in errors."""

ListNodes = Callable[[], tuple[set[str], Mapping[str, bool]]]
"""Full names of this process's nodes; those of other processes, with whether they
serve their parameters."""


class NodeMonitor:
    """Probes the nodes and reports their states to the clients.

    Args:
        run_soon: runs a function on the executor's thread.
        list_nodes: called on the executor's thread.
        now_s: monotonic wall time.
    """

    def __init__(
        self,
        hub: Hub,
        call: Call,
        run_soon: RunSoon,
        list_nodes: ListNodes,
        service_calls: ServiceCalls,
        remote: RemoteParameters,
        now_s: Callable[[], float],
    ) -> None:
        self._hub = hub
        self._call = call
        self._run_soon = run_soon
        self._list_nodes = list_nodes
        self._service_calls = service_calls
        self._remote = remote
        self._probe = LivenessProbe(service_calls, now_s)
        self._now_s = now_s
        self._reports: list[NodeReport] = []
        self._is_scheduled = False
        self._scheduled_s = 0.0
        self._is_active = False  # the probe has state to reset

    def on_period(self) -> None:
        """Check once; the socket thread calls this every ``liveness.PERIOD_S``."""
        if self._is_scheduled:
            waited_s = self._now_s() - self._scheduled_s
            if waited_s > _BLOCKED_S:
                self._hub.set_nodes(self._reports, waited_s)
        elif (
            self._hub.wants_node_reports
            or self._is_active
            or self._service_calls.pending
        ):
            self._is_scheduled, self._scheduled_s = True, self._now_s()
            self._run_soon(self._check, "node monitor")

    def _check(self) -> None:
        self._is_scheduled = False
        self._service_calls.expire()
        self._is_active = self._hub.wants_node_reports
        if not self._is_active:
            self._probe.reset()
            return
        self._remote.fetch()
        here, others = self._list_nodes()
        self._reports = self._probe.step(here, others)
        self._call(self._hub.set_nodes, self._reports, 0.0)
