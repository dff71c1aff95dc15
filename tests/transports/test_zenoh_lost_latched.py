"""The last latched message comes, even if the link was congested when it was sent."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Queue

import pytest
from transport_pairs import LIMIT_S, until, zenoh_environment

from free_ports import free_endpoint
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.runtime import (
    Context,
    DurabilityPolicy,
    Executor,
    Node,
    Publisher,
    QoSProfile,
)
from navette.runtime.clock import Stopwatch

pytestmark = pytest.mark.skipif(os.name == "nt", reason="stops a process by SIGSTOP")

WAIT_BEFORE_DROP_S = 0.05  # for a full link of one machine (config.py)
ZENOHS_WAIT_S = 5.0  # for a full link, before it is closed
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
CELLS = 50_000  # one packet: long messages are divided
MOST_MAPS = 2000  # more than the buffers of a link hold
# Prints the width of each map.
SUBSCRIBER = """
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.runtime import Context, DurabilityPolicy, Executor, Node, QoSProfile
context = Context()
context.init(args=[])
node = Node("reader", context=context)
qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
show = lambda grid: print(grid.info.width, flush=True)
node.create_subscription(OccupancyGrid, "map", show, qos)
executor = Executor(context=context)
executor.add_node(node)
executor.spin()
"""


@pytest.fixture
def writer(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    # The machine may be so busy that a stopped reader is silent for longer than 10 s.
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", "transport/link/tx/lease=120000")
    context = Context(transport="zenoh")
    context.init(args=[], initialize_logging=False)
    node = Node("writer", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield node
    executor.stop()
    thread.join()
    context.shutdown()


def a_map(width: int) -> OccupancyGrid:
    grid = OccupancyGrid(data=bytes(CELLS))
    grid.info.width = width
    return grid


def publish_until_full(publisher: Publisher[OccupancyGrid]) -> int:
    """Publish maps 2, 3, … and three that the full link drops; return the last one."""
    for width in range(2, MOST_MAPS):
        watch = Stopwatch()
        publisher.publish(a_map(width))
        if watch.elapsed_s >= WAIT_BEFORE_DROP_S:
            for more in (1, 2, 3):
                publisher.publish(a_map(width + more))
            return width + 3
    raise AssertionError("the link holds every map")


@contextmanager
def a_reader(widths: Queue[int]) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-c", SUBSCRIBER]
    environment = zenoh_environment(os.environ["NAVETTE_ROUTER"])
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, text=True
    ) as reader:
        lines = reader.stdout or ()

        def read() -> None:
            for line in lines:
                widths.put(int(line))

        threading.Thread(target=read, daemon=True).start()
        try:
            yield reader
        finally:
            reader.kill()


@contextmanager
def a_stopped_reader(
    publisher: Publisher[OccupancyGrid], widths: Queue[int]
) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """Yield a stopped reader that has map 1, and the last map; its link is full."""
    with a_reader(widths) as reader:
        until(lambda: publisher.get_subscription_count() == 1, "the reader")
        publisher.publish(a_map(1))
        assert widths.get(timeout=LIMIT_S) == 1
        os.kill(reader.pid, signal.SIGSTOP)
        yield reader, publish_until_full(publisher)


def test_the_last_map_reaches_a_reader_that_was_stopped(writer: Node) -> None:
    publisher = writer.create_publisher(OccupancyGrid, "map", LATCHED)
    widths: Queue[int] = Queue()
    with a_stopped_reader(publisher, widths) as (reader, last):
        os.kill(reader.pid, signal.SIGCONT)
        received = [1]
        while received[-1] != last:
            received.append(widths.get(timeout=LIMIT_S))
    assert len(received) < last, "nothing was lost"


@pytest.mark.slow
@pytest.mark.long
def test_a_link_that_was_full_for_longer_than_zenoh_waits_is_kept(writer: Node) -> None:
    """With Zenoh's own 5 s the link was closed and never opened again."""
    publisher = writer.create_publisher(OccupancyGrid, "map", LATCHED)
    widths: Queue[int] = Queue()
    with a_stopped_reader(publisher, widths) as (reader, last):
        # Its declaration cannot be dropped.
        writer.create_publisher(OccupancyGrid, "other_map", LATCHED)
        threading.Event().wait(ZENOHS_WAIT_S + 1.0)
        os.kill(reader.pid, signal.SIGCONT)
        while widths.get(timeout=LIMIT_S) != last:
            pass
        assert publisher.get_subscription_count() == 1
