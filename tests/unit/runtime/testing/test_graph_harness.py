"""GraphHarness."""

import pytest

from navette.errors import InvalidValueError
from navette.msgs.std_msgs.msg import Float64, String
from navette.runtime import Node
from navette.runtime.testing import GraphHarness


def doubling(graph: GraphHarness) -> Node:
    node = graph.add(Node("doubles", context=graph.context))
    publisher = node.create_publisher(Float64, "out", 10)
    node.create_subscription(
        Float64, "in", lambda m: publisher.publish(Float64(data=2 * m.data)), 10
    )
    return node


def test_publish_run_collect() -> None:
    with GraphHarness() as graph:
        doubling(graph)
        out = graph.collect("out", "std_msgs/msg/Float64")
        graph.publish("in", Float64(data=2.0))
        graph.run_for(1.0)
        assert out.last.data == 4.0
        assert out.stamps_ns == [0]
        assert graph.now_ns == 1_000_000_000
        out.clear()
        assert out.count == 0
        with pytest.raises(InvalidValueError, match="no message has arrived on out"):
            _ = out.last


def test_publish_every_and_run_until() -> None:
    with GraphHarness() as graph:
        doubling(graph)
        out = graph.collect("out", Float64)
        graph.publish_every(0.1, "in", lambda now_ns: Float64(data=now_ns / 1e9))
        assert graph.run_until(lambda: out.count == 3)
        assert [m.data for m in out.messages] == pytest.approx([0.2, 0.4, 0.6])
        assert not graph.run_until(lambda: False, timeout_s=0.5)


def test_two_harnesses_are_isolated() -> None:
    with GraphHarness() as one, GraphHarness() as other:
        received = other.collect("t", String)
        one.publish("t", String())
        one.run_for(1.0)
        other.run_for(1.0)
        assert received.count == 0


def test_arguments_apply_to_the_nodes() -> None:
    with GraphHarness(args=["--ros-args", "-r", "in:=/elsewhere"]) as graph:
        node = doubling(graph)
        assert node.count_subscribers("/elsewhere") == 1


def test_a_closed_harness_has_no_nodes() -> None:
    graph = GraphHarness()
    doubling(graph)
    graph.close()
    assert graph.context.nodes == []
