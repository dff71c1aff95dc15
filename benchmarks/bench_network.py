"""Round trips between two processes of one machine, compared with Zenoh and a peer.

The same bytes, as a sensor_msgs/Image, are sent to a second process, which returns
them: Navette's nodes with queues, CDR and executor, decoded or as bytes (``raw=True``,
what a recorder or a relay uses); zenoh-python, which moves bytes
without encoding, and returns them unread; zenoh-ros2-sdk, with the same wire format;
dora-rs, whose Python nodes exchange Arrow arrays. All use shared memory. Half the time
of a round trip is the latency of a message.

dora-rs takes part if ``dora-rs`` and ``dora-rs-cli`` are installed.
"""

import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, ClassVar

from harness import Benchmark, Figure, optional

SIZES = {"64 B": 64, "4 kB": 4096, "64 kB": 65_536, "1 MB": 1 << 20, "8 MB": 8 << 20}
DOMAIN = "77"
PATIENCE_S = 20.0


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


# -- the three implementations, each a function to send and one to subscribe --------


def navette_peer(
    name: str, size: int, out: str, back: str, *, raw: bool = False
) -> Any:
    from navette.msgs import serialize
    from navette.msgs.sensor_msgs.msg import Image
    from navette.runtime import Context, Executor, Node, QoSProfile

    context = Context(transport="zenoh")
    context.init(args=[], initialize_logging=False)
    node = Node(name, context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    publisher = node.create_publisher(Image, out, QoSProfile(depth=10))
    image = Image(height=1, width=size, step=size, encoding="mono8")
    image.data = bytes(size)

    def listen(callback: Callable[[Any], None]) -> None:
        node.create_subscription(Image, back, callback, QoSProfile(depth=10), raw=raw)

    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()

    def close() -> None:
        executor.stop()
        thread.join()
        context.shutdown()

    return serialize(image) if raw else image, publisher.publish, listen, close


def navette_bytes_peer(name: str, size: int, out: str, back: str) -> Any:
    return navette_peer(name, size, out, back, raw=True)


def zenoh_peer(name: str, size: int, out: str, back: str) -> Any:
    import zenoh

    config = zenoh.Config()
    here = os.environ["BENCH_LISTEN"]
    there = os.environ["BENCH_CONNECT"]
    config.insert_json5("mode", '"peer"')
    config.insert_json5("listen/endpoints", f'["{here}"]')
    config.insert_json5("connect/endpoints", f'["{there}"]')
    config.insert_json5("scouting/multicast/enabled", "false")
    session = zenoh.open(config)
    publisher = session.declare_publisher(f"bench{out}")

    def listen(callback: Callable[[Any], None]) -> None:
        session.declare_subscriber(
            f"bench{back}", lambda sample: callback(sample.payload)
        )

    return bytes(size), publisher.put, listen, session.close


def sdk_peer(name: str, size: int, out: str, back: str) -> Any:
    import numpy as np
    from zenoh_ros2_sdk import ROS2Publisher, ROS2Subscriber

    from navette.msgs import definition_text, type_hash

    kind = "sensor_msgs/msg/Image"
    text = definition_text(kind)
    where: dict[str, Any] = {
        "router_port": int(os.environ["NAVETTE_ROUTER"].rpartition(":")[2]),
        "domain_id": int(DOMAIN),
        "type_hash": type_hash(kind),
    }
    publisher = ROS2Publisher(out, kind, text, node_name=name, **where)
    types = publisher.session_mgr.store.types  # classes made from the text
    stamp = types["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
    fields = {
        "header": types["std_msgs/msg/Header"](stamp=stamp, frame_id=""),
        "height": 1,
        "width": size,
        "encoding": "mono8",
        "is_bigendian": 0,
        "step": size,
        "data": np.zeros(size, np.uint8),
    }

    def listen(callback: Callable[[Any], None]) -> None:
        ROS2Subscriber(back, kind, callback, text, node_name=f"{name}_in", **where)

    def send(message: Any) -> None:
        publisher.publish(**(message if isinstance(message, dict) else vars(message)))

    return fields, send, listen, publisher.close


def dora_peer(name: str, size: int, out: str, back: str) -> Any:
    import numpy as np
    import pyarrow as pa
    from dora import Node

    node = Node(f"{name}-{size}")
    callbacks: list[Callable[[Any], None]] = []

    def receive() -> None:
        event = node.next(timeout=PATIENCE_S)
        if event is not None and event["type"] == "INPUT":
            callbacks[0](event["value"])

    def echo_all() -> None:
        while True:
            receive()

    def listen(callback: Callable[[Any], None]) -> None:
        callbacks.append(callback)
        if name == "echo":
            threading.Thread(target=echo_all, daemon=True).start()

    def send(data: Any) -> None:
        node.send_output(out[1:], data)
        if name != "echo":  # without a second thread, as dora's examples
            receive()

    return pa.array(np.zeros(size, np.uint8)), send, listen, lambda: None


def start_dataflow(size: int, stack: ExitStack) -> None:
    """Start dora's daemon, and the dataflow that connects the two nodes."""
    ends = {"bench": ("there", "back"), "echo": ("back", "there")}
    other = {"bench": "echo", "echo": "bench"}
    nodes = [
        {
            "id": f"{name}-{size}",
            "path": "dynamic",
            "inputs": {read: f"{other[name]}-{size}/{read}"},
            "outputs": [written],
        }
        for name, (written, read) in ends.items()
    ]
    folder = stack.enter_context(tempfile.TemporaryDirectory())
    (Path(folder) / "flow.yml").write_text(json.dumps({"nodes": nodes}))
    quiet: dict[str, Any] = {
        "cwd": folder,
        "check": True,
        "stdout": subprocess.DEVNULL,
        "stderr": subprocess.DEVNULL,
    }
    subprocess.run(["dora", "up"], **quiet)
    stack.callback(
        subprocess.run, ["dora", "destroy", "--force"], **{**quiet, "check": False}
    )
    subprocess.run(["dora", "start", "flow.yml", "--detach"], **quiet)


PEERS = {
    "navette": navette_peer,
    "navette, bytes": navette_bytes_peer,
    "zenoh-python": zenoh_peer,
    "zenoh-ros2-sdk": sdk_peer,
    "dora-rs": dora_peer,
}


def echo(peer: str, size: int) -> None:
    """The second process: echoes messages until its input ends."""
    _, send, listen, close = PEERS[peer]("echo", size, "/back", "/there")
    listen(send)
    print("ready", flush=True)
    sys.stdin.read()
    close()


class Loop:
    """One implementation with an echo in another process; a call is one round trip."""

    children: ClassVar[list[subprocess.Popen[str]]] = []
    dataflows: ClassVar[ExitStack] = ExitStack()

    def __init__(self, peer: str, size: int, stack: ExitStack) -> None:
        ends = [f"tcp/127.0.0.1:{free_port()}" for _ in range(2)]
        common = {
            "NAVETTE_ROUTER": f"tcp/127.0.0.1:{free_port()}",
            "ROS_DOMAIN_ID": DOMAIN,
        }
        os.environ.update(common, BENCH_LISTEN=ends[0], BENCH_CONNECT=ends[1])
        if peer == "dora-rs":
            start_dataflow(size, self.dataflows)
        # Navette's router serves the peer as well.
        router = None
        if peer == "zenoh-ros2-sdk":
            router = navette_peer("router", 1, "/unused", "/unused_back")
            stack.callback(router[3])
        self.message, self._send, listen, close = PEERS[peer](
            "bench", size, "/there", "/back"
        )
        self._came = threading.Event()
        listen(lambda _: self._came.set())
        environment = {
            **os.environ,
            "BENCH_LISTEN": ends[1],
            "BENCH_CONNECT": ends[0],
        }
        self._process = subprocess.Popen(
            [sys.executable, __file__, "--echo", peer, str(size)],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.children.append(self._process)
        stack.callback(self._end, close)
        assert self._process.stdout is not None
        while "ready" not in self._process.stdout.readline():
            assert self._process.poll() is None, "the echo ended"
        self._connect()

    def __call__(self) -> None:
        self._came.clear()
        self._send(self.message)
        assert self._came.wait(PATIENCE_S), "no echo"

    def _connect(self) -> None:
        for _ in range(200):
            self._send(self.message)
            if self._came.wait(0.1):
                break
        # Messages sent meanwhile are echoed, too.
        while True:
            self._came.clear()
            if not self._came.wait(0.3):
                return

    def _end(self, close: Callable[[], None]) -> None:
        self._process.kill()  # the peer's does not end by itself
        self._process.communicate()
        close()


def build(stack: ExitStack) -> Benchmark:
    bench = Benchmark("network", __doc__, budget_s=1.5)
    modules = {
        "zenoh-python": "zenoh",
        "zenoh-ros2-sdk": "zenoh_ros2_sdk",
        "dora-rs": "dora",
    }
    peers = [w for w in PEERS if w not in modules or optional(modules[w])]
    for label, size in SIZES.items():
        loops = {peer: Loop(peer, size, stack) for peer in peers}
        bench.case(f"{label}, round trip", loops)

    def throughput() -> Figure:
        times = bench.results["8 MB, round trip"]["navette"]
        return Figure(
            "8 MB images, both directions together",
            2 * (8 << 20) / 1e6 / (times.median_ms / 1e3),
            "MB/s",
            more_is_better=True,
        )

    bench.figure(throughput)
    return bench


if __name__ == "__main__":
    if sys.argv[1:2] == ["--echo"]:
        echo(sys.argv[2], int(sys.argv[3]))
    else:
        with ExitStack() as everything:
            build(everything).main()
            sys.stdout.flush()
            for child in Loop.children:
                child.kill()
            Loop.dataflows.close()
            os._exit(0)  # the peer's session does not always end when it is closed
