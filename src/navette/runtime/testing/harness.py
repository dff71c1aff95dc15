"""Graph harness: runs nodes in virtual time, publishes inputs and collects outputs.

::

    with GraphHarness() as graph:
        node = graph.add(CostmapNode(context=graph.context))
        costmaps = graph.collect("/costmap", "nav_msgs/msg/OccupancyGrid")
        graph.publish("/lidar", scan)
        graph.run_for(0.5)
        assert costmaps.last.info.width == 200
"""

from collections.abc import Callable, Sequence
from typing import Any, Self, TypeVar

from navette.errors import InvalidValueError
from navette.msgs import get_interface
from navette.runtime import (
    Context,
    ContextClock,
    DurabilityPolicy,
    Executor,
    Node,
    Parameter,
    Publisher,
    QoSProfile,
    ReliabilityPolicy,
    VirtualClock,
)
from navette.runtime.testing.goal_probe import GoalProbe

N = TypeVar("N", bound=Node)


class Probe:
    """Messages that arrived on a topic, with the times of arrival (ns)."""

    def __init__(self, topic: str) -> None:
        self.topic = topic
        self.messages: list[Any] = []
        self.stamps_ns: list[int] = []

    @property
    def last(self) -> Any:
        """The newest message.

        Raises:
            InvalidValueError: no message has arrived.
        """
        if not self.messages:
            raise InvalidValueError(f"no message has arrived on {self.topic}")
        return self.messages[-1]

    @property
    def count(self) -> int:
        return len(self.messages)

    def clear(self) -> None:
        self.messages.clear()
        self.stamps_ns.clear()


class GraphHarness:
    """Runs nodes in a separate context with virtual time.

    Args:
        args: ROS arguments, such as ``["--ros-args", "-r", "a:=b"]``.
        clock: default: a virtual clock that starts at zero.
    """

    def __init__(
        self, *, args: Sequence[str] = (), clock: ContextClock | None = None
    ) -> None:
        self.context = Context(clock=clock or VirtualClock())
        self.context.init(list(args))
        self.executor = Executor(context=self.context)
        self.node = Node(
            "harness",
            context=self.context,
            enable_rosout=False,
            parameter_overrides=[
                Parameter("start_type_description_service", value=False)
            ],
            start_parameter_services=False,
        )  # publishes and collects for the test
        self.executor.add_node(self.node)
        #: By topic and type.
        self._publishers: dict[tuple[str, type], Publisher[Any]] = {}

    def add(self, node: N) -> N:
        """Add a node that was created in :attr:`context`, and return it."""
        self.executor.add_node(node)
        return node

    @property
    def now_ns(self) -> int:
        return self.context.clock.now_ns

    def publish(self, topic: str, message: Any, *, latched: bool = False) -> None:
        """Publish a message; the publisher continues to exist."""
        publisher = self._publishers.get((topic, type(message)))
        if publisher is None:
            qos = QoSProfile(depth=100, durability=_durability(latched=latched))
            publisher = self.node.create_publisher(type(message), topic, qos)
            self._publishers[topic, type(message)] = publisher
        publisher.publish(message)

    def publish_every(
        self, period_s: float, topic: str, make: Callable[[int], Any]
    ) -> None:
        """Publish ``make(now_ns)`` periodically, first after one period."""
        self.node.create_timer(period_s, lambda: self.publish(topic, make(self.now_ns)))

    def collect(
        self, topic: str, message: str | type, *, latched: bool = False
    ) -> Probe:
        """Collect the messages of a topic, with ``latched`` also the last samples."""
        probe = Probe(topic)

        def receive(msg: Any) -> None:
            probe.messages.append(msg)
            probe.stamps_ns.append(self.now_ns)

        kind = get_interface(message) if isinstance(message, str) else message
        qos = QoSProfile(
            depth=1000,
            durability=_durability(latched=latched),
            reliability=ReliabilityPolicy.BEST_EFFORT,
        )
        self.node.create_subscription(kind, topic, receive, qos)
        return probe

    def send_goal(self, action: Any, name: str, goal: Any) -> GoalProbe:
        """Send a goal to an action server; the probe collects what it returns."""
        return GoalProbe(self.node, action, name, goal)

    def call(self, service: Any, name: str, request: Any) -> Any:
        """Call a service and return its response.

        Raises:
            InvalidValueError: no response within 10 s of virtual time.
        """
        client = self.node.create_client(service, name)
        future = client.call_async(request)
        if not self.run_until(future.done, 10.0):
            raise InvalidValueError(f"no response from service {name} within 10 s")
        self.node.destroy_client(client)
        return future.result()

    def run_for(self, seconds: float) -> None:
        """Run all events of a span of virtual time."""
        self.executor.spin_for(round(seconds * 1e9))

    def run_until(self, condition: Callable[[], bool], timeout_s: float = 60.0) -> bool:
        """Run until the condition holds or the timeout; return whether it holds."""
        return self.executor.spin_until_complete(condition, round(timeout_s * 1e9))

    def close(self) -> None:
        self.context.try_shutdown()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def _durability(*, latched: bool) -> DurabilityPolicy:
    return DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
