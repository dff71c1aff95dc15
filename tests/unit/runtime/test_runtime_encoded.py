"""Messages that are published as bytes."""

import logging

import pytest

from navette.msgs import serialize
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import String
from navette.runtime import DurabilityPolicy, QoSProfile
from navette.testing import GraphHarness

LATCHED = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize("shared", [True, False])
def test_each_reader_gets_the_message(shared: bool) -> None:
    with GraphHarness() as graph:
        heard: list[list[str]] = [[], []]
        for each in heard:
            graph.node.create_subscription(
                String, "t", lambda m, e=each: e.append(m.data), 10, shared=shared
            )
        publisher = graph.node.create_publisher(String, "t", 10)
        publisher.publish_encoded(serialize(String(data="a")))
        publisher.publish(String(data="b"))
        graph.run_for(0.1)
        assert heard == [["a", "b"], ["a", "b"]]


def test_readers_do_not_share_the_decoded_object() -> None:
    with GraphHarness() as graph:
        heard: list[OccupancyGrid] = []
        for _ in range(2):
            graph.node.create_subscription(OccupancyGrid, "t", heard.append, 10)
        publisher = graph.node.create_publisher(OccupancyGrid, "t", 10)
        publisher.publish_encoded(serialize(OccupancyGrid(data=[1, 2])))
        graph.run_for(0.1)
        heard[0].data[0] = 7
        assert list(heard[1].data) == [1, 2]


def test_raw_readers_get_the_very_bytes() -> None:
    with GraphHarness() as graph:
        heard: list[bytes] = []
        graph.node.create_subscription(String, "t", heard.append, 10, raw=True)
        data = serialize(String(data="as it was"))
        graph.node.create_publisher(String, "t", 10).publish_encoded(data)
        graph.run_for(0.1)
        assert heard == [data]


def test_late_joiners_get_latched_bytes() -> None:
    with GraphHarness() as graph:
        publisher = graph.node.create_publisher(String, "t", LATCHED)
        for text in "abc":
            publisher.publish_encoded(serialize(String(data=text)))
        heard: list[str] = []
        graph.node.create_subscription(
            String, "t", lambda m: heard.append(m.data), LATCHED
        )
        graph.run_for(0.1)
        assert heard == ["b", "c"]


def test_what_cannot_be_decoded_is_reported_and_left_out(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with GraphHarness() as graph:
        heard: list[str] = []
        graph.node.create_subscription(String, "t", lambda m: heard.append(m.data), 10)
        publisher = graph.node.create_publisher(String, "t", 10)
        with caplog.at_level(logging.WARNING, logger="navette"):
            publisher.publish_encoded(b"\x00\x01\x00\x00\xff")
            publisher.publish_encoded(serialize(String(data="good")))
            graph.run_for(0.1)
        assert heard == ["good"]
        assert "/t: message not delivered" in caplog.text
