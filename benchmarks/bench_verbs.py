"""Commands that inspect a running program, from process start to end.

A program runs in a process of its own; each verb is a new process that joins the
network, looks, prints and leaves, with nothing prepared. The target is half a second.
"""

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from harness import Benchmark, Run

PROGRAM = """
import navette
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import Image
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import DurabilityPolicy, QoSProfile
navette.init(args=[])
node = navette.Node("mapper")
node.declare_parameter("resolution_m", 0.05)
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
publisher = node.create_publisher(OccupancyGrid, "map", latched)
grid = OccupancyGrid(data=[0] * 250_000)
grid.info.width = grid.info.height = 500
publisher.publish(grid)
camera = node.create_publisher(Image, "camera", latched)
camera.publish(Image(data=bytes(range(250)) * 24_000))
node.create_service(Trigger, "clear", lambda request, response: response)
print("ready", flush=True)
navette.spin(node)
"""
VERBS = (
    ("topic", "list", "-t"),
    ("topic", "info", "-v", "/map"),
    ("topic", "echo", "/map", "--once"),
    ("topic", "echo", "/camera", "--once", "-f"),
    ("topic", "type", "/map"),
    ("topic", "find", "nav_msgs/msg/OccupancyGrid"),
    ("interface", "show", "nav_msgs/msg/OccupancyGrid"),
    ("interface", "list"),
    ("node", "list"),
    ("node", "info", "/mapper"),
    ("param", "get", "/mapper", "resolution_m"),
    ("param", "dump", "/mapper"),
    ("service", "list", "-t"),
    ("service", "call", "/clear"),
    ("action", "list"),
    ("lifecycle", "nodes"),
)
TARGET_MS = 500
"""Perceived as immediate."""
IMAGE_TARGET_MS = 1000
"""For 6 MB as text."""


@contextmanager
def program(environment: dict[str, str]) -> Iterator[None]:
    """The program that the verbs inspect."""
    running = subprocess.Popen(
        [sys.executable, "-c", PROGRAM],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert running.stdout is not None
        assert running.stdout.readline() == "ready\n"
        yield
    finally:
        running.kill()
        running.communicate()


def verb(environment: dict[str, str], *arguments: str) -> Run:
    command = [sys.executable, "-c", "from navette.cli import main; main()", *arguments]

    def run() -> str:
        done = subprocess.run(
            command,
            check=True,
            capture_output=True,
            text=True,
            env=environment,
            timeout=60,
        )
        return done.stdout

    return run


def main() -> None:
    bench = Benchmark("verbs", __doc__)
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    environment = {
        **os.environ,
        "NAVETTE_ROUTER": f"tcp/127.0.0.1:{port}",
        "NAVETTE_TRANSPORT": "zenoh",
    }
    with program(environment):
        assert "/map" in str(verb(environment, "topic", "list")())
        for arguments in VERBS:
            bench.case(
                f"navette {' '.join(arguments)}",
                {"navette": verb(environment, *arguments)},
                target_ms=IMAGE_TARGET_MS if "-f" in arguments else TARGET_MS,
            )
        bench.main()


if __name__ == "__main__":
    main()
