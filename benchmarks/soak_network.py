"""Some minutes of load between two processes, to check that memory stays flat.

One process publishes images (1 MB at 20 Hz, reliable, read by the other), 500 small
messages a second and a latched map once a second, makes and destroys a publisher and a
subscription every second, and calls a service of the other at 20 Hz. Prints the
resident memory of both every five seconds, and by what it grew from the first to the
last third of what is judged::

    python benchmarks/soak_network.py --minutes 4

Zenoh keeps 0.8 kB of every request until its time is over (NAVETTE_SERVICE_TIMEOUT,
here ``--service-timeout``), and only then as much is given back as is taken: the run is
judged from there on. The names of the topics that come and go come again, ten in all:
what Zenoh keeps of a name stays as long as a link does (docs/decisions/0018), and
``--new-names`` shows it. Single megabytes come and go with the images that are on their
way.
"""

import argparse
import os
import socket
import statistics
import subprocess
import sys
import time
from pathlib import Path

from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import Image
from navette.msgs.std_msgs.msg import Float64
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import (
    Context,
    DurabilityPolicy,
    Executor,
    Node,
    QoSProfile,
)

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
FLAT_MB = 3.0
NEW_NAMES = "SOAK_NEW_NAMES" in os.environ
# Imports, first allocations, Zenoh's pools.
WARM_UP_S = 15.0
SAMPLE_S = 5.0


class Talker(Node):
    """Generates the load."""

    def __init__(self, context: Context) -> None:
        super().__init__("talker", context=context)
        self.image = Image(height=1, width=1 << 20, step=1 << 20, encoding="mono8")
        self.image.data = bytes(1 << 20)
        self.map = OccupancyGrid()
        self.map.info.width = self.map.info.height = 300
        self.map.data = bytes(90_000)
        self.images = self.create_publisher(Image, "/image", 5)
        self.maps = self.create_publisher(OccupancyGrid, "/map", LATCHED)
        self.values = self.create_publisher(Float64, "/value", 100)
        self.client = self.create_client(Trigger, "/ask")
        self.answers = self.round = 0
        self.create_timer(0.05, self.send_image)
        self.create_timer(0.002, lambda: self.values.publish(Float64(data=1.0)))
        self.create_timer(1.0, self.change)

    def send_image(self) -> None:
        self.images.publish(self.image)
        if self.client.service_is_ready():
            self.client.call_async(Trigger.Request()).add_done_callback(self.count)

    def count(self, _: object) -> None:
        self.answers += 1

    def change(self) -> None:
        self.maps.publish(self.map)
        self.round += 1
        name = self.round if NEW_NAMES else self.round % 10
        publisher = self.create_publisher(Float64, f"/passing/round_{name}", 10)
        subscription = self.create_subscription(
            Float64, "/echoed", lambda message: None, 10
        )
        publisher.publish(Float64(data=2.0))
        self.destroy_publisher(publisher)
        self.destroy_subscription(subscription)


class Listener(Node):
    """Subscribes to all topics and serves requests."""

    def __init__(self, context: Context) -> None:
        super().__init__("listener", context=context)
        self.received = {"/image": 0, "/map": 0, "/value": 0}
        for topic, kind, qos in (
            ("/image", Image, 5),
            ("/map", OccupancyGrid, LATCHED),
            ("/value", Float64, 100),
        ):
            self.create_subscription(kind, topic, self.counter_of(topic), qos)
        self.create_service(Trigger, "/ask", self.answer)
        self.create_timer(5.0, lambda: print(self.received, flush=True))

    def counter_of(self, topic: str):  # type: ignore[no-untyped-def]
        def count(_: object) -> None:
            self.received[topic] += 1

        return count

    def answer(
        self, request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        response.success = True
        return response


def spin(make: type[Node], seconds: float | None) -> Node:
    context = Context(transport="zenoh")
    context.init(args=[], initialize_logging=False)
    node = make(context)
    executor = Executor(context=context)
    executor.add_node(node)
    if seconds is None:
        executor.spin()
    else:
        executor.spin_for(round(seconds * 1e9))
    return node


def resident_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE") / 1e6


def growth(samples: list[float]) -> float:
    third = len(samples) // 3
    return statistics.median(samples[-third:]) - statistics.median(samples[:third])


def soak(minutes: float, service_timeout_s: float, *, new_names: bool) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    env = {
        **os.environ,
        "NAVETTE_ROUTER": f"tcp/127.0.0.1:{port}",
        "NAVETTE_SERVICE_TIMEOUT": str(service_timeout_s),
    }
    if new_names:
        env["SOAK_NEW_NAMES"] = "1"
    pipe = subprocess.PIPE
    listener = subprocess.Popen(
        [sys.executable, __file__, "--role", "listener"],
        env=env,
        stdout=pipe,
        text=True,
    )
    talker = subprocess.Popen(
        [sys.executable, __file__, "--role", "talker"], env=env, stdout=pipe, text=True
    )
    memory: dict[str, list[float]] = {"talker": [], "listener": []}
    try:
        time.sleep(WARM_UP_S + service_timeout_s)
        end = time.monotonic() + 60 * minutes
        while time.monotonic() < end:
            memory["talker"].append(resident_mb(talker.pid))
            memory["listener"].append(resident_mb(listener.pid))
            print(*(f"{who} {m[-1]:.1f} MB" for who, m in memory.items()), flush=True)
            time.sleep(SAMPLE_S)
    finally:
        for process in (talker, listener):
            process.terminate()
    assert listener.stdout is not None
    print("received", listener.stdout.read().splitlines()[-1])
    for who, samples in memory.items():
        grown = growth(samples)
        print(f"{who}: grew {grown:+.1f} MB:", "flat" if grown < FLAT_MB else "GROWS")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=3.0)
    parser.add_argument("--service-timeout", type=float, default=30.0)
    parser.add_argument("--new-names", action="store_true")
    parser.add_argument("--role", choices=("talker", "listener"))
    given = parser.parse_args()
    if given.role is None:
        soak(given.minutes, given.service_timeout, new_names=given.new_names)
    else:
        spin(Talker if given.role == "talker" else Listener, None)
