"""Guard conditions, waiting for a message, serialisation, names."""

import threading

import pytest

from navette.errors import DecodeError
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import (
    Context,
    Node,
    SystemClock,
    VirtualClock,
    deserialize_message,
    serialize_message,
    spin_once,
)
from navette.runtime.exceptions import InvalidParameterException
from navette.runtime.names import topic_or_service_is_hidden
from navette.runtime.parameter import validate_parameter_name
from navette.runtime.wait_for_message import wait_for_message
from navette.testing import GraphHarness


def test_guard_condition(graph: GraphHarness) -> None:
    calls: list[int] = []
    guard = graph.node.create_guard_condition(lambda: calls.append(1))
    graph.run_for(0.1)
    assert calls == []
    guard.trigger()
    guard.trigger()
    graph.run_for(0.1)
    assert calls == [1]
    guard.trigger()
    assert list(graph.node.guards) == [guard]
    assert guard.callback_group is graph.node.default_callback_group
    assert graph.node.destroy_guard_condition(guard)
    graph.run_for(0.1)
    assert calls == [1]
    assert not graph.node.destroy_guard_condition(guard)


def test_guard_condition_from_another_thread() -> None:
    context = Context(clock=SystemClock())
    node = Node("n", context=context)
    calls: list[int] = []
    guard = node.create_guard_condition(lambda: calls.append(1))
    thread = threading.Thread(target=guard.trigger)
    thread.start()
    spin_once(node, timeout_sec=10.0)
    thread.join()
    assert calls == [1]
    context.shutdown()


def test_wait_for_message(graph: GraphHarness) -> None:
    graph.publish_every(1.0, "/t", lambda now_ns: String(data=str(now_ns)))
    found = wait_for_message(String, graph.node, "/t", time_to_wait=5.0)
    assert found == (True, String(data="1000000000"))
    lonely = Node("lonely", context=graph.context)  # in no executor
    assert wait_for_message(String, lonely, "/t")[1] == String(data="2000000000")
    assert wait_for_message(String, graph.node, "/x", time_to_wait=2) == (False, None)
    assert graph.now_ns == 4_000_000_000
    assert graph.node.count_subscribers("/t") == 0


def test_wait_for_message_from_a_callback(graph: GraphHarness) -> None:
    graph.publish_every(1.0, "/t", lambda now_ns: String(data=str(now_ns)))
    node = graph.add(Node("n", context=graph.context))
    found: list[object] = []
    # It waits for longer than its period: the run must end all the same.
    node.create_timer(
        0.5, lambda: found.append(wait_for_message(String, node, "/t")[0])
    )
    graph.run_for(0.5)
    assert found == [True, True]
    assert graph.now_ns == 2_000_000_000


def test_serialization() -> None:
    data = serialize_message(String(data="x"))
    assert deserialize_message(data, String) == String(data="x")
    with pytest.raises(DecodeError):
        deserialize_message(b"\x00", String)
    with pytest.raises(TypeError, match="which is a service"):
        deserialize_message(data, Trigger)
    with pytest.raises(TypeError, match="no ROS 2 interface"):
        serialize_message("x")


def test_names() -> None:
    assert topic_or_service_is_hidden("/fib/_action/feedback")
    assert not topic_or_service_is_hidden("/a_b/c")
    assert validate_parameter_name("a.b")
    with pytest.raises(InvalidParameterException):
        validate_parameter_name("")


def test_a_node_without_executor_has_no_callbacks() -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    guard = node.create_guard_condition(lambda: pytest.fail("in no executor"))
    guard.trigger()
    context.loop.run(until_ns=1)
