"""Messages that are published as serialised data."""

import logging

import pytest

from navette.msgs import serialize
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import String
from navette.runtime import DurabilityPolicy, QoSProfile
from navette.runtime.testing import GraphHarness

LATCHED = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize("shared", [True, False])
def test_each_subscription_gets_the_message(shared: bool) -> None:
    with GraphHarness() as graph:
        received: list[list[str]] = [[], []]
        for each in received:
            graph.node.create_subscription(
                String, "t", lambda m, e=each: e.append(m.data), 10, shared=shared
            )
        publisher = graph.node.create_publisher(String, "t", 10)
        publisher.publish_encoded(serialize(String(data="a")))
        publisher.publish(String(data="b"))
        graph.run_for(0.1)
        assert received == [["a", "b"], ["a", "b"]]


def test_subscriptions_do_not_share_the_decoded_object() -> None:
    with GraphHarness() as graph:
        received: list[OccupancyGrid] = []
        for _ in range(2):
            graph.node.create_subscription(OccupancyGrid, "t", received.append, 10)
        publisher = graph.node.create_publisher(OccupancyGrid, "t", 10)
        publisher.publish_encoded(serialize(OccupancyGrid(data=[1, 2])))
        graph.run_for(0.1)
        received[0].data[0] = 7
        assert list(received[1].data) == [1, 2]


def test_raw_subscriptions_get_the_original_bytes() -> None:
    with GraphHarness() as graph:
        received: list[bytes] = []
        graph.node.create_subscription(String, "t", received.append, 10, raw=True)
        data = serialize(String(data="as it was"))
        graph.node.create_publisher(String, "t", 10).publish_encoded(data)
        graph.run_for(0.1)
        assert received == [data]


def test_late_subscriptions_get_latched_bytes() -> None:
    with GraphHarness() as graph:
        publisher = graph.node.create_publisher(String, "t", LATCHED)
        for text in "abc":
            publisher.publish_encoded(serialize(String(data=text)))
        received: list[str] = []
        graph.node.create_subscription(
            String, "t", lambda m: received.append(m.data), LATCHED
        )
        graph.run_for(0.1)
        assert received == ["b", "c"]


def test_undecodable_data_is_reported_and_not_delivered(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with GraphHarness() as graph:
        received: list[str] = []
        graph.node.create_subscription(
            String, "t", lambda m: received.append(m.data), 10
        )
        publisher = graph.node.create_publisher(String, "t", 10)
        with caplog.at_level(logging.WARNING, logger="navette"):
            publisher.publish_encoded(b"\x00\x01\x00\x00\xff")
            publisher.publish_encoded(serialize(String(data="good")))
            graph.run_for(0.1)
        assert received == ["good"]
        assert "/t: message not delivered" in caplog.text
