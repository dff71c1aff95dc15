"""Publishers and subscriptions."""

import math
from typing import Any

import pytest

from navette.errors import CallbackError, InvalidValueError, MessageError
from navette.msgs import serialize
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import Bool, Float64, String
from navette.runtime import (
    Context,
    DurabilityPolicy,
    Executor,
    MessageInfo,
    Node,
    QoSProfile,
    ReliabilityPolicy,
    VirtualClock,
    qos_profile_sensor_data,
)
from navette.runtime.exceptions import InvalidHandle
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    QoSIncompatibleInfo,
    QoSMatchedInfo,
    SubscriptionEventCallbacks,
)
from navette.runtime.testing import GraphHarness


def test_talker_and_listener() -> None:
    context = Context(clock=VirtualClock())
    talker = Node("talker", context=context)
    listener = Node("listener", context=context)
    publisher = talker.create_publisher(String, "chatter", 10)
    received: list[str] = []
    listener.create_subscription(
        String, "chatter", lambda m: received.append(m.data), 10
    )
    talker.create_timer(
        0.5, lambda: publisher.publish(String(data=f"hello {len(received)}"))
    )
    executor = Executor(context=context)
    executor.add_node(talker)
    executor.add_node(listener)
    executor.spin_for(2_000_000_000)
    assert received == ["hello 0", "hello 1", "hello 2", "hello 3"]


@pytest.mark.parametrize(("depth", "expected"), [(1, ["9"]), (3, ["7", "8", "9"])])
def test_queue_keeps_the_newest(
    graph: GraphHarness, depth: int, expected: list[str]
) -> None:
    received: list[str] = []
    graph.node.create_subscription(
        String, "t", lambda m: received.append(m.data), depth
    )
    for number in range(10):
        graph.publish("t", String(data=str(number)))
    graph.run_for(0)
    assert received == expected


def test_a_callback_may_take_the_message_info(graph: GraphHarness) -> None:
    infos: list[MessageInfo] = []
    graph.node.create_subscription(String, "t", lambda m, info: infos.append(info), 10)
    graph.run_for(1.5)
    graph.publish("t", String(data="a"))
    graph.publish("t", String(data="b"))
    graph.run_for(0)
    assert infos[1] == {
        "source_timestamp": 1_500_000_000,
        "received_timestamp": 1_500_000_000,
        "publication_sequence_number": 2,
        "reception_sequence_number": 2,
    }


def test_callback_with_a_default_argument_gets_the_message_only(
    graph: GraphHarness,
) -> None:
    seen: list[Any] = []
    graph.node.create_subscription(
        String, "t", lambda m, extra="mine": seen.append(extra), 10
    )
    graph.publish("t", String())
    graph.run_for(0)
    assert seen == ["mine"]


def test_raw_subscriptions_and_publishing_bytes(graph: GraphHarness) -> None:
    seen: list[bytes] = []
    graph.node.create_subscription(String, "t", seen.append, 10, raw=True)
    publisher = graph.node.create_publisher(String, "t", 10)
    publisher.publish(serialize(String(data="over the wire")))
    graph.run_for(0)
    assert seen == [serialize(String(data="over the wire"))]


def test_a_wrong_message_type_raises(graph: GraphHarness) -> None:
    publisher = graph.node.create_publisher(String, "t", 10)
    with pytest.raises(MessageError, match=r"/t: expected std_msgs/msg/String, got"):
        publisher.publish(Float64())  # type: ignore[arg-type]
    with pytest.raises(TypeError):  # what rclpy raises
        publisher.publish("text")  # type: ignore[arg-type]


def test_another_type_on_the_topic_raises_and_leaves_no_endpoint(
    graph: GraphHarness,
) -> None:
    graph.node.create_publisher(String, "t", 10)
    before = graph.context.graph.endpoints()
    with pytest.raises(InvalidValueError, match="has the type std_msgs/msg/String"):
        graph.node.create_subscription(Float64, "t", lambda m: None, 10)
    with pytest.raises(InvalidValueError, match="cannot publish std_msgs/msg/Float"):
        graph.node.create_publisher(Float64, "t", 10)
    assert graph.context.graph.endpoints() == before


def test_a_topic_may_have_the_types_that_its_endpoints_expect(
    graph: GraphHarness,
) -> None:
    texts, numbers = [], []
    early = graph.node.create_publisher(Float64, "t", 10)
    for kind, other, got in ((String, Float64, texts), (Float64, String, numbers)):
        graph.node.create_subscription(kind, "t", got.append, 10, other_types=[other])
    graph.node.create_publisher(String, "t", 10).publish(String(data="a"))
    early.publish(Float64(data=1.0))
    graph.run_for(0.0)
    assert (texts, numbers) == ([String(data="a")], [Float64(data=1.0)])
    with pytest.raises(InvalidValueError, match="has the type"):
        graph.node.create_publisher(Bool, "t", 10)


def test_a_subscription_may_ignore_publishers_of_its_own_node(
    graph: GraphHarness,
) -> None:
    received: list[String] = []
    subscription = graph.node.create_subscription(
        String, "t", received.append, 10, ignore_local_publications=True
    )
    own = graph.node.create_publisher(String, "t", 10)
    other = graph.add(Node("other", context=graph.context))
    own.publish(String(data="own"))
    other.create_publisher(String, "t", 10).publish(String(data="other"))
    graph.run_for(0.0)
    assert received == [String(data="other")]
    assert subscription.get_publisher_count() == 1
    assert own.get_subscription_count() == 0


def test_late_subscriber_gets_the_latched_map(graph: GraphHarness) -> None:
    graph.publish("map", String(data="the map"), latched=True)
    graph.run_for(1.0)
    probe = graph.collect("map", String, latched=True)
    graph.run_for(0)
    assert [m.data for m in probe.messages] == ["the map"]


def test_incompatible_qos_is_warned_about_once_on_both_sides(
    graph: GraphHarness,
) -> None:
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    talker = graph.add(Node("talker", context=graph.context))
    listener = graph.add(Node("listener", context=graph.context))
    publisher = talker.create_publisher(String, "t", qos_profile_sensor_data)
    listener.create_subscription(
        String,
        "t",
        lambda m: pytest.fail("must not match"),
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    )
    publisher.publish(String())
    publisher.publish(String())
    graph.run_for(1.0)
    assert {m.name for m in logs.messages} == {"talker", "listener"}
    assert logs.count == 2
    for message in logs.messages:
        assert "RELIABILITY (offered BEST_EFFORT, requested RELIABLE)" in message.msg
        assert "DURABILITY (offered VOLATILE" in message.msg
    assert publisher.get_subscription_count() == 0


def test_event_callbacks_replace_the_warning(graph: GraphHarness) -> None:
    events: list[Any] = []
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    node = graph.add(Node("n", context=graph.context))
    node.create_publisher(
        String,
        "t",
        best_effort,
        event_callbacks=PublisherEventCallbacks(
            incompatible_qos=events.append, matched=events.append
        ),
    )
    node.create_subscription(
        String,
        "t",
        lambda m: None,
        1,
        event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
    )
    graph.run_for(0)
    fitting = node.create_subscription(String, "t", lambda m: None, best_effort)
    graph.run_for(0)
    node.destroy_subscription(fitting)
    graph.run_for(0)
    assert isinstance(events[0], QoSIncompatibleInfo)
    assert events[0].last_policy_kind.name == "RELIABILITY"
    assert events[1:] == [QoSMatchedInfo(1, 1, 1, 1), QoSMatchedInfo(1, 0, 0, -1)]
    assert logs.count == 0


def test_counts(graph: GraphHarness) -> None:
    publisher = graph.node.create_publisher(String, "t", 10)
    assert publisher.get_subscription_count() == 0
    subscription = graph.node.create_subscription(String, "t", lambda m: None, 10)
    assert publisher.get_subscription_count() == 1
    assert subscription.get_publisher_count() == 1
    subscription.destroy()
    assert publisher.get_subscription_count() == 0


def test_a_destroyed_publisher_raises(graph: GraphHarness) -> None:
    publisher = graph.node.create_publisher(String, "t", 10)
    assert graph.node.destroy_publisher(publisher)
    with pytest.raises(InvalidHandle, match="/t"):
        publisher.publish(String())


def test_a_destroyed_subscription_gets_no_queued_samples(
    graph: GraphHarness,
) -> None:
    subscription = graph.node.create_subscription(
        String, "t", lambda m: pytest.fail("was destroyed"), 10
    )
    graph.publish("t", String())
    graph.node.destroy_subscription(subscription)
    graph.run_for(1.0)


def test_messages_wait_until_the_node_is_added(graph: GraphHarness) -> None:
    node = Node("late", context=graph.context)
    received: list[str] = []
    node.create_subscription(String, "t", lambda m: received.append(m.data), 2)
    for text in "abc":
        graph.publish("t", String(data=text))
    graph.run_for(1.0)
    assert received == []
    graph.add(node)
    graph.run_for(0)
    assert received == ["b", "c"]


def test_raising_callback_names_node_topic_and_stamp(graph: GraphHarness) -> None:
    def bad(message: String) -> None:
        raise KeyError("missing")

    graph.node.create_subscription(String, "t", bad, 10)
    graph.run_for(2.0)
    graph.publish("t", String())
    with pytest.raises(CallbackError) as caught:
        graph.run_for(1.0)
    assert str(caught.value) == (
        "node /harness: callback of topic /t raised at 2.000 s: KeyError: 'missing'"
    )


def test_a_callback_that_is_not_callable_raises(graph: GraphHarness) -> None:
    with pytest.raises(TypeError, match="callback None: expected a function"):
        graph.node.create_subscription(String, "t", None, 10)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "callback", [None, lambda: None, lambda message, info, more: None]
)
def test_a_callback_of_another_signature_raises(
    graph: GraphHarness, callback: Any
) -> None:
    with pytest.raises(RuntimeError, match="expected a function of the message"):
        graph.node.create_subscription(String, "t", callback, 10)


@pytest.mark.parametrize("qos", [-1, "10", True, None])
def test_invalid_qos_raises(graph: GraphHarness, qos: Any) -> None:
    with pytest.raises((InvalidValueError, TypeError)):
        graph.node.create_publisher(String, "t", qos)


def test_callback_can_be_replaced(graph: GraphHarness) -> None:
    seen: list[str] = []
    subscription = graph.node.create_subscription(
        String, "t", lambda m: seen.append("old"), 10
    )
    subscription.callback = lambda m, info: seen.append("new")
    graph.publish("t", String())
    graph.run_for(0)
    assert seen == ["new"]


def test_endless_ping_pong_does_not_starve_timers(
    graph: GraphHarness,
) -> None:
    hits = 0

    def again(message: String) -> None:
        nonlocal hits
        hits += 1
        if hits < 1000:
            graph.publish("t", message)

    graph.node.create_subscription(String, "t", again, 10)
    graph.publish("t", String())
    graph.run_for(0)
    assert hits == 1000


def test_shared_subscriptions_receive_the_object_that_is_handed_over(
    graph: GraphHarness,
) -> None:
    received: list[OccupancyGrid] = []
    publisher = graph.node.create_publisher(OccupancyGrid, "map", 1)
    for shared in (True, True, False, False):
        graph.node.create_subscription(
            OccupancyGrid, "map", received.append, 1, shared=shared
        )
    message = OccupancyGrid(data=[1, 2, 3])
    publisher.hand_over(message)
    graph.run_for(0)
    assert [each is message for each in received].count(True) == 2
    own = [each for each in received if each is not message]
    assert own[0] is not own[1]
    own[0].data[0] = 7
    assert [each.data[0] for each in (message, own[1])] == [1, 1]


def test_a_destroyed_publisher_hands_nothing_over(graph: GraphHarness) -> None:
    publisher = graph.node.create_publisher(String, "t", 1)
    publisher.destroy()
    with pytest.raises(InvalidHandle):
        publisher.hand_over(String(data="late"))


def used_ms(graph: GraphHarness, *rates_hz: float) -> list[int]:
    """Return the stamps of a source of 50 Hz that readers of these rates use."""
    publisher = graph.node.create_publisher(String, "scan", 10)
    for rate_hz in rates_hz:
        graph.node.create_subscription(String, "scan", print, 10).limit_rate(rate_hz)
    return [k for k in range(0, 200, 20) if publisher.is_used(k * 1_000_000)]


@pytest.mark.parametrize("readers", [1, 3])
def test_a_fast_source_need_not_make_what_all_readers_skip(
    graph: GraphHarness, readers: int
) -> None:
    assert used_ms(graph, *readers * [20.0]) == [0, 40, 80, 140, 180]


@pytest.mark.parametrize("rates_hz", [(), (math.inf,), (20.0, math.inf), (20.0, 10.0)])
def test_a_source_makes_all_if_its_readers_do_not_agree(
    graph: GraphHarness, rates_hz: tuple[float, ...]
) -> None:
    assert used_ms(graph, *rates_hz) == list(range(0, 200, 20))


def test_a_reader_of_all_messages_may_come_and_go(graph: GraphHarness) -> None:
    publisher = graph.node.create_publisher(String, "scan", 10)
    graph.node.create_subscription(String, "scan", print, 10).limit_rate(20.0)
    assert [publisher.is_used(k * 20_000_000) for k in range(4)] == [1, 0, 1, 0]
    recorder = graph.node.create_subscription(String, "scan", print, 10)
    assert [publisher.is_used(k * 20_000_000) for k in (4, 5)] == [1, 1]
    graph.node.destroy_subscription(recorder)
    assert [publisher.is_used(k * 20_000_000) for k in range(6, 10)] == [0, 1, 0, 1]
