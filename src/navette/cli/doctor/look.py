"""Take a snapshot of the running system: graph, responses, status topics and clock."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from navette.cli.doctor.snapshot import Snapshot, StageStatus
from navette.cli.service_calls import node_names
from navette.cli.session import endpoints, is_hidden, service_endpoints, wait_for
from navette.msgs.topics import CLOCK, ODOMETRY
from navette.transports import Endpoint, EndpointKind

if TYPE_CHECKING:
    from navette.runtime import Future, Node

LOOK_S = 1.2  # more than two status periods of a stage

_STATUS = "diagnostic_msgs/msg/DiagnosticStatus"
_GET = "rcl_interfaces/srv/GetParameters"
_SANE_AGE_S = 3600.0  # older stamps come from another clock


def look(
    here: "Node",
    known: Sequence[str],
    published: Mapping[str, Sequence[str]] | None = None,
) -> Snapshot:
    """Request and subscribe until all nodes have responded, at most 1.2 s.

    Args:
        known: full names of the nodes that the router lists.
        published: topics by node, as listed by the router.
    """
    nodes = node_names(here, hidden=True)
    topics = endpoints(here)
    services = service_endpoints(here)
    received = _Subscriptions(here, topics)
    requests = _request_sim_time(here, services)

    def is_complete() -> bool:
        answered = all(future.done() for future in requests.values())
        return answered and received.is_complete()

    wait_for(here, is_complete, LOOK_S if topics or requests else 0.0)
    unreached = sorted(n for n in {*known} - {*nodes} if not is_hidden(n))
    return Snapshot(
        nodes=tuple(nodes),
        endpoints=tuple(topics),
        services=tuple(services),
        sim_time={name: _is_simulated(future) for name, future in requests.items()},
        unreached=tuple(unreached),
        unreached_topics={
            name: tuple(sorted(set((published or {}).get(name, ()))))
            for name in unreached
        },
        speed_mps=received.speed_mps,
        clock_ticks=received.clock_ns is not None,
        heartbeats=tuple(received.heartbeats()),
    )


def _request_sim_time(
    here: "Node", services: list[Endpoint]
) -> "dict[str, Future[Any]]":
    """Request use_sim_time from all nodes, which also shows whether they respond."""
    from navette.msgs import get_interface

    served = {
        end.node_full_name
        for end in services
        if end.type_name == _GET and end.kind is EndpointKind.SERVICE
    }
    requests = {}
    for name in sorted(served):
        client = here.create_client(get_interface(_GET), f"{name}/get_parameters")
        request = client.srv_type.Request(names=["use_sim_time"])
        requests[name] = client.call_async(request)
    return requests


def _is_simulated(future: "Future[Any]") -> bool | None:
    """Return a node's use_sim_time; None without a response."""
    if not future.done() or future.exception() is not None:
        return None
    response = future.result()
    return response is not None and any(v.bool_value for v in response.values)


class _Subscriptions:
    """Subscriptions to /clock, the odometry and all status topics."""

    def __init__(self, here: "Node", topics: list[Endpoint]) -> None:
        self._here = here
        #: Newest time of /clock.
        self.clock_ns: int | None = None
        self._has_clock = False
        #: Speed of the robot; None before the first odometry.
        self.speed_mps: float | None = None
        self._has_odometry = False
        self._last: dict[str, tuple[Any, int]] = {}
        self._count: dict[str, int] = {}
        for end in topics:
            if end.kind is not EndpointKind.PUBLISHER:
                continue
            if end.topic == CLOCK.name and not self._has_clock:
                self._subscribe_clock()
            elif _is_odometry(end) and not self._has_odometry:
                self._subscribe_odometry(end)
            elif _is_heartbeat(end) and end.topic not in self._count:
                self._subscribe_status(end)

    def is_complete(self) -> bool:
        """Whether a message has arrived on every topic."""
        waits_for_clock = self._has_clock and self.clock_ns is None
        waits_for_speed = self._has_odometry and self.speed_mps is None
        waits = waits_for_clock or waits_for_speed
        return not waits and all(map(self._is_alive, self._count))

    def heartbeats(self) -> list[StageStatus]:
        beats = []
        for topic in sorted(self._count):
            if topic not in self._last:
                beats.append(StageStatus(topic))
                continue
            status, _ = self._last[topic]
            level = status.level[0]
            age_s = self._age_s(topic)
            beats.append(StageStatus(topic, status.message, level, age_s))
        return beats

    def _subscribe_clock(self) -> None:
        from navette.msgs.rosgraph_msgs.msg import Clock
        from navette.runtime import QoSProfile, ReliabilityPolicy
        from navette.runtime.time import stamp_to_ns

        def on_clock(message: Any) -> None:
            self.clock_ns = stamp_to_ns(message.clock)

        self._has_clock = True
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._here.create_subscription(Clock, CLOCK.name, on_clock, qos)

    def _subscribe_odometry(self, end: Endpoint) -> None:
        from navette.msgs.nav_msgs.msg import Odometry
        from navette.runtime import qos_profile_sensor_data

        def on_odometry(message: Any) -> None:
            velocity = message.twist.twist.linear
            self.speed_mps = math.hypot(velocity.x, velocity.y)

        self._has_odometry = True
        self._here.create_subscription(
            Odometry, end.topic, on_odometry, qos_profile_sensor_data
        )

    def _subscribe_status(self, end: Endpoint) -> None:
        from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
        from navette.runtime import QoSProfile

        def on_status(message: Any, info: Any) -> None:
            self._last[end.topic] = message, info["source_timestamp"]
            self._count[end.topic] += 1

        self._count[end.topic] = 0
        qos = QoSProfile.from_endpoint_qos(end.qos)
        self._here.create_subscription(DiagnosticStatus, end.topic, on_status, qos)

    def _is_alive(self, topic: str) -> bool:
        age_s = self._age_s(topic)
        return age_s is not None and age_s < LOOK_S

    def _age_s(self, topic: str) -> float | None:
        """Return the age by the clock of the stamp, which is system or simulated time.

        With another clock, a single status may be an old latched one; two are new.
        """
        if topic not in self._last:
            return None
        stamp_ns = self._last[topic][1]
        clocks = [self._here.get_clock().now_ns, self.clock_ns]
        ages = [(now - stamp_ns) / 1e9 for now in clocks if now is not None]
        sane = [age for age in ages if abs(age) < _SANE_AGE_S]
        if sane:
            return max(0.0, min(sane))
        return 0.0 if self._count[topic] > 1 else None


def _is_odometry(end: Endpoint) -> bool:
    return end.topic == ODOMETRY.name and end.type_name == ODOMETRY.type


def _is_heartbeat(end: Endpoint) -> bool:
    return end.topic.endswith("/status") and end.type_name == _STATUS
