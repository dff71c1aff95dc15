"""Polling by handles, as in programs with a copy of rclpy's wait_for_message."""

from typing import Any

import pytest

from navette.msgs import serialize
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Node, QoSProfile
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.poll_set import PollSet
from navette.runtime.testing import GraphHarness
from navette.runtime.time import Duration


def poll_set(context: Context) -> PollSet:
    return PollSet(1, 1, 0, 0, 0, 0, context.handle)


def never(message: Any) -> None:
    pytest.fail("polled, not called back")


def lonely(graph: GraphHarness) -> Node:
    return Node("lonely", context=graph.context)  # without an executor


def test_samples_are_taken_one_by_one(graph: GraphHarness) -> None:
    subscription = lonely(graph).create_subscription(String, "/t", never, 10)
    publisher = graph.node.create_publisher(String, "/t", 10)
    handle = subscription.handle
    with handle:
        assert handle.take_message(String, raw=False) is None
        for text in ("a", "b"):
            publisher.publish(String(data=text))
        graph.run_for(0.1)
        taken = handle.take_message(String, raw=False)
        assert taken is not None
        assert taken[0] == String(data="a")
        assert taken[1]["reception_sequence_number"] == 1
        taken = handle.take_message(String, raw=True)
        assert taken is not None
        assert taken[0] == serialize(String(data="b"))
        assert handle.take_message(String, raw=False) is None


def test_expired_samples_are_not_taken(graph: GraphHarness) -> None:
    qos = QoSProfile(depth=10, lifespan=Duration(seconds=1))
    subscription = lonely(graph).create_subscription(String, "/t", never, 10)
    publisher = graph.node.create_publisher(String, "/t", qos)
    publisher.publish(String(data="old"))
    graph.run_for(2.0)
    assert subscription.handle.take_message(String, raw=True) is None
    publisher.publish(String(data="old"))
    graph.run_for(2.0)
    publisher.publish(String(data="new"))
    taken = subscription.handle.take_message(String, raw=False)
    assert taken is not None
    assert taken[0] == String(data="new")


def test_waiting_for_a_sample(graph: GraphHarness) -> None:
    graph.publish_every(1.0, "/t", lambda now_ns: String(data=str(now_ns)))
    subscription = lonely(graph).create_subscription(String, "/t", never, 1)
    guard = GuardCondition(context=graph.context)
    waits = poll_set(graph.context)
    assert waits.add_subscription(subscription.handle) == 0
    assert waits.add_guard_condition(guard.handle) == 0
    waits.wait(500_000_000)
    assert graph.now_ns == 500_000_000
    assert waits.get_ready_entities("subscription") == []
    waits.wait()
    assert graph.now_ns == 1_000_000_000
    assert subscription.handle.pointer in waits.get_ready_entities("subscription")
    assert guard.handle.pointer not in waits.get_ready_entities("guard_condition")
    assert waits.is_ready("subscription", 0)
    assert not waits.is_ready("guard_condition", 0)


def test_waiting_for_a_trigger(graph: GraphHarness) -> None:
    guard = GuardCondition(context=graph.context)
    waits = poll_set(graph.context)
    waits.add_guard_condition(guard.handle)
    graph.context.loop.call_at(2_000_000_000, guard.trigger)
    waits.wait()
    assert graph.now_ns == 2_000_000_000
    assert waits.get_ready_entities("guard_condition") == [guard.handle.pointer]
    waits.clear_entities()
    waits.wait(1_000_000)
    assert waits.get_ready_entities("guard_condition") == []
