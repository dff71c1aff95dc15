"""From publish to callback in one process, compared with Zenoh; timers and tf lookups.

Navette's path includes the queue, the deterministic executor, QoS and a copy of the
message. Zenoh's session calls back from within ``put`` and carries constant bytes
(loopback only: no listening, no scouting).
"""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

from harness import Benchmark, optional

from navette.msgs import deserialize, serialize
from navette.msgs.geometry_msgs.msg import TransformStamped, Twist
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.runtime import Buffer, Context, Executor, Node, Time, VirtualClock

zenoh: Any = optional("zenoh")

COUNT = 1000
BURST = 100


class Graph:
    """A node with its own context and executor."""

    def __init__(self) -> None:
        self.context = Context(clock=VirtualClock())
        self.context.init(args=[])
        self.node = Node("bench", context=self.context)
        self.executor = Executor(context=self.context)
        self.executor.add_node(self.node)
        self.received = 0

    def sender(
        self, message: Any, topic: str, *, shared: bool = False
    ) -> Callable[[], None]:
        """Publish ``COUNT`` messages in bursts and run their callbacks."""

        def count(_: Any) -> None:
            self.received += 1

        publisher = self.node.create_publisher(type(message), topic, BURST)
        self.node.create_subscription(type(message), topic, count, BURST, shared=shared)

        def run() -> None:
            before = self.received
            for _ in range(COUNT // BURST):
                for _ in range(BURST):
                    publisher.publish(message)
                self.executor.spin_for(0)
            assert self.received == before + COUNT

        return run

    def timer(self) -> Callable[[], None]:
        """Run a 1 kHz timer for ``COUNT`` periods."""
        fired = 0

        def fire() -> None:
            nonlocal fired
            fired += 1

        self.node.create_timer(1e-3, fire)

        def run() -> None:
            before = fired
            self.executor.spin_for(COUNT * 1_000_000)
            assert fired == before + COUNT

        return run


def zenoh_sender(
    payload: bytes, name: str, *, reads: type | None
) -> Callable[[], None]:
    """The same with a Zenoh session; ``reads`` also encodes and decodes the message."""
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("listen/endpoints", "[]")
    for way in ("multicast", "gossip"):
        config.insert_json5(f"scouting/{way}/enabled", "false")
    session = zenoh.open(config)
    received = 0
    message = None if reads is None else deserialize(payload, reads)

    def count(sample: Any) -> None:
        nonlocal received
        received += 1
        if reads is not None:
            deserialize(sample.payload.to_bytes(), reads)

    callback = zenoh.handlers.Callback(count, indirect=False)  # no thread between
    keep = session, session.declare_subscriber(f"bench/{name}", callback)
    publisher = session.declare_publisher(f"bench/{name}")

    def run(keep: Any = keep) -> None:
        before = received
        for _ in range(COUNT):
            publisher.put(payload if message is None else serialize(message))
        assert received == before + COUNT

    return run


def chain(stamps: int = 100) -> Buffer:
    """map → odom → base → lidar; the middle one moves."""
    buffer = Buffer()
    frames = ("map", "odom", "base_link", "lidar")
    for parent, child in pairwise(frames):
        for i in range(stamps):
            transform = TransformStamped(child_frame_id=child)
            transform.header.frame_id = parent
            transform.header.stamp = Time(nanoseconds=i * 10_000_000).to_msg()
            transform.transform.translation.x = 0.01 * i
            transform.transform.rotation.w = 1.0
            if child == "base_link":
                buffer.set_transform(transform)
            elif i == 0:
                buffer.set_transform_static(transform)
    return buffer


def lookups(buffer: Buffer) -> Callable[[], None]:
    stamps = [Time(nanoseconds=500_000_000 + i * 100_000) for i in range(COUNT)]
    middle = buffer.lookup_transform("map", "lidar", stamps[50])
    assert abs(middle.transform.translation.x - 0.505) < 1e-9

    def run() -> None:
        for stamp in stamps:
            buffer.lookup_transform("map", "lidar", stamp)

    return run


def add_messages(bench: Benchmark) -> None:
    twist, scan = Twist(), LaserScan(ranges=[1.0] * 720)
    cases = (("Twist", twist, 1e-3), ("LaserScan, 720 beams", scan, None))
    for name, message, target_ms in cases:
        topic = type(message).__name__
        contenders = {
            "navette": Graph().sender(message, topic),
            "navette, read only": Graph().sender(message, topic, shared=True),
        }
        if zenoh is not None:
            data = serialize(message)
            contenders["zenoh, bytes"] = zenoh_sender(data, topic, reads=None)
            contenders["zenoh, with Navette's CDR"] = zenoh_sender(
                data, f"{topic}2", reads=type(message)
            )
        bench.case(
            f"{name}: publish → 1 callback",
            contenders,
            "all messages were received",
            target_ms=target_ms,
            per_run=COUNT,
        )


def main() -> None:
    bench = Benchmark("in-process dispatch", __doc__)
    add_messages(bench)
    bench.case("timer, 1 kHz", {"navette": Graph().timer()}, per_run=COUNT)
    bench.case("tf lookup, 4 frames", {"navette": lookups(chain())}, per_run=COUNT)
    bench.main()


if __name__ == "__main__":
    main()
