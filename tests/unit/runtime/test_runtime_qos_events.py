"""Deadlines, liveliness, QoS overrides, compatibility."""

from typing import Any

import pytest

from navette.msgs import serialize
from navette.msgs.std_msgs.msg import String
from navette.runtime import (
    DurabilityPolicy,
    Duration,
    LivelinessPolicy,
    Node,
    Parameter,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
    qos_profile_system_default,
)
from navette.runtime.qos import (
    DeadlineBestAvailable,
    LivelinessLeaseDurationeBestAvailable,
    QoSCompatibility,
    QoSPolicyKind,
    QoSReliabilityPolicy,
    qos_check_compatible,
)
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    QoSCountInfo,
    QoSLivelinessChangedInfo,
    QoSPublisherEventType,
    SubscriptionEventCallbacks,
)
from navette.runtime.qos_overriding_options import (
    InvalidQosOverridesError,
    QosCallbackResult,
    QoSOverridingOptions,
)
from navette.runtime.testing import GraphHarness

Changed = QoSLivelinessChangedInfo


def test_deadlines_of_publisher_and_subscription(graph: GraphHarness) -> None:
    qos = QoSProfile(depth=10, deadline=Duration(seconds=0.6))
    offered: list[Any] = []
    requested: list[Any] = []
    received: list[float] = []
    publisher = graph.node.create_publisher(
        String,
        "t",
        qos,
        event_callbacks=PublisherEventCallbacks(deadline=offered.append),
    )
    graph.node.create_subscription(
        String,
        "t",
        lambda m: received.append(graph.now_ns / 1e9),
        qos,
        event_callbacks=SubscriptionEventCallbacks(deadline=requested.append),
    )
    graph.run_for(5.0)
    assert offered == []  # starts with the first message
    timer = graph.node.create_timer(0.5, lambda: publisher.publish(String()))
    graph.run_for(2.0)
    assert (offered, requested, len(received)) == ([], [], 4)
    timer.cancel()
    graph.run_for(1.3)
    assert offered == requested == [QoSCountInfo(1, 1), QoSCountInfo(2, 1)]
    timer.reset()
    graph.run_for(1.0)
    assert len(offered) == 3
    timer.cancel()
    publisher.destroy()
    graph.run_for(10.0)
    assert len(offered) == 3
    assert len(requested) > 10


def test_automatic_liveliness(graph: GraphHarness) -> None:
    changes: list[Any] = []
    graph.node.create_subscription(
        String,
        "t",
        lambda m: None,
        10,
        event_callbacks=SubscriptionEventCallbacks(liveliness=changes.append),
    )
    publisher = graph.node.create_publisher(String, "t", 10)
    graph.run_for(1.0)
    publisher.destroy()
    graph.run_for(1.0)
    assert changes == [Changed(1, 0, 1, 0), Changed(0, 0, -1, 0)]


def test_manual_liveliness(graph: GraphHarness) -> None:
    qos = QoSProfile(
        depth=10,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=1),
    )
    lost: list[Any] = []
    changes: list[Any] = []
    callbacks = SubscriptionEventCallbacks(liveliness=changes.append)
    publisher = graph.node.create_publisher(
        String,
        "t",
        qos,
        event_callbacks=PublisherEventCallbacks(liveliness=lost.append),
    )
    graph.node.create_subscription(
        String, "t", lambda m: None, qos, event_callbacks=callbacks
    )
    graph.run_for(5.0)
    assert changes == []
    publisher.assert_liveliness()
    graph.run_for(0.9)
    publisher.publish(String())
    graph.run_for(0.9)
    late: list[Any] = []
    graph.node.create_subscription(
        String,
        "t",
        lambda m: None,
        qos,
        event_callbacks=SubscriptionEventCallbacks(liveliness=late.append),
    )
    assert lost == []
    graph.run_for(3.0)
    assert lost == [QoSCountInfo(1, 1)]
    assert changes == late == [Changed(1, 0, 1, 0), Changed(0, 1, -1, 1)]
    publisher.assert_liveliness()
    graph.run_for(0.1)
    assert changes[-1] == Changed(1, 0, 1, -1)
    publisher.destroy()
    graph.run_for(3.0)
    assert (changes[-1], len(lost)) == (Changed(0, 0, -1, 0), 1)


def test_an_assertion_that_misses_a_subscription_is_warned_about_once(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    qos = QoSProfile(
        depth=10,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=1),
    )
    publisher = graph.node.create_publisher(String, "t", qos)
    reported: list[str] = []
    graph.context.log.sinks.append(lambda record: reported.append(record.message))
    publisher.assert_liveliness()
    assert reported == []
    monkeypatch.setattr(type(publisher.ports[0]), "assert_alive", lambda _: False)
    for _ in range(2):
        publisher.assert_liveliness()
    assert len(reported) == 1
    assert "publish one within the lease" in reported[0]


def test_an_assertion_without_a_lease_has_no_effect(graph: GraphHarness) -> None:
    graph.node.create_publisher(String, "t", 10).assert_liveliness()


def overriding(graph: GraphHarness, **overrides: Any) -> Node:
    return Node(
        "n",
        context=graph.context,
        parameter_overrides=[
            Parameter(f"qos_overrides./t.{name}", value=value)
            for name, value in overrides.items()
        ],
    )


def test_qos_overrides(graph: GraphHarness) -> None:
    node = overriding(
        graph,
        **{
            "publisher.depth": 7,
            "publisher.reliability": "best_effort",
            "subscription_b.durability": "transient_local",
            "subscription_b.deadline": 5,
        },
    )
    given = QoSProfile(depth=1)
    publisher = node.create_publisher(
        String,
        "t",
        given,
        qos_overriding_options=QoSOverridingOptions.with_default_policies(),
    )
    assert publisher.qos_profile.depth == 7
    assert publisher.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert given == QoSProfile(depth=1)
    assert node.describe_parameter("qos_overrides./t.publisher.history").read_only
    options = QoSOverridingOptions(
        [QoSPolicyKind.DURABILITY, QoSPolicyKind.DEADLINE, QoSPolicyKind.LIFESPAN],
        entity_id="b",
    )
    for _ in range(2):  # the parameters are declared once
        subscription = node.create_subscription(
            String, "t", lambda m: None, 3, qos_overriding_options=options
        )
        assert subscription.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        assert subscription.qos_profile.deadline == Duration(nanoseconds=5)
    assert not node.has_parameter("qos_overrides./t.subscription_b.lifespan")


def test_qos_overrides_can_be_rejected(graph: GraphHarness) -> None:
    node = overriding(graph, **{"publisher.depth": 70})

    def check(qos: QoSProfile) -> Any:
        return QosCallbackResult(successful=qos.depth <= 10, reason="too deep")

    options = QoSOverridingOptions.with_default_policies(callback=check)
    with pytest.raises(
        InvalidQosOverridesError, match=r"publisher of /t are .* too deep"
    ):
        node.create_publisher(String, "t", 1, qos_overriding_options=options)
    other = overriding(graph, **{"publisher.reliability": "good"})
    with pytest.raises(InvalidQosOverridesError, match=r"'good'; known: .*reliable"):
        other.create_publisher(
            String,
            "t",
            1,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )


def test_compatibility() -> None:
    reliable = QoSProfile(depth=1)
    assert qos_check_compatible(reliable, reliable) == (QoSCompatibility.OK, "")
    state, reason = qos_check_compatible(qos_profile_sensor_data, reliable)
    assert (state, reason) == (
        QoSCompatibility.ERROR,
        "ERROR: incompatible: reliability",
    )
    state, reason = qos_check_compatible(reliable, qos_profile_system_default)
    assert state is QoSCompatibility.WARNING
    assert "subscription reliability" in reason


def test_deprecated_names() -> None:
    assert (
        QoSReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT
        is ReliabilityPolicy.BEST_EFFORT
    )
    assert "best_effort" in ReliabilityPolicy.short_keys()
    assert not any("rmw" in key for key in LivelinessPolicy.short_keys())


def aging(graph: GraphHarness, **qos: Any) -> Any:
    node = graph.add(Node("talker", context=graph.context))
    profile = QoSProfile(depth=5, lifespan=Duration(seconds=1), **qos)
    return node.create_publisher(String, "news", profile)


def test_late_subscriptions_get_no_expired_samples(graph: GraphHarness) -> None:
    latched = DurabilityPolicy.TRANSIENT_LOCAL
    publisher = aging(graph, durability=latched)
    publisher.publish(String(data="old"))
    graph.run_for(0.6)
    publisher.publish(String(data="young"))
    graph.run_for(0.6)
    node = graph.add(Node("late", context=graph.context))
    received: list[str] = []
    read: list[str] = []
    qos = QoSProfile(depth=5, durability=latched)
    node.create_subscription(String, "news", lambda m: received.append(m.data), qos)
    node.create_subscription(
        String, "news", lambda m, _: read.append(m.data), qos, shared=True
    )
    graph.run_for(0.1)
    assert received == read == ["young"]


def test_samples_that_expire_in_the_queue_are_dropped(graph: GraphHarness) -> None:
    publisher = aging(graph)
    node = Node(
        "slow", context=graph.context
    )  # without an executor its events are parked
    received: list[str] = []
    raw: list[bytes] = []
    node.create_subscription(String, "news", lambda m: received.append(m.data), 10)
    node.create_subscription(String, "news", raw.append, 10, raw=True)
    taken = node.create_subscription(String, "news", print, 10)
    message = String(data="old")
    publisher.publish(message)
    graph.run_for(0.9)
    message.data = "young"  # the published sample does not change
    publisher.publish(message)
    graph.run_for(0.2)
    assert taken.take() == String(data="young")
    assert taken.take() is None
    graph.add(node)
    graph.run_for(0.1)
    assert received == ["young"]
    assert len(raw) == 1


def test_a_lifespan_applies_to_serialised_messages(graph: GraphHarness) -> None:
    publisher = aging(graph, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher.publish(serialize(String(data="bytes")))
    probe = graph.collect("/news", String, latched=True)
    graph.run_for(0.1)
    assert probe.last.data == "bytes"
    graph.run_for(1.0)
    late = graph.collect("/news", String, latched=True)
    graph.run_for(0.1)
    assert late.count == 0


def test_lost_messages_are_reported(graph: GraphHarness) -> None:
    reported: list[QoSCountInfo] = []
    callbacks = SubscriptionEventCallbacks(message_lost=reported.append)
    node = graph.add(Node("n", context=graph.context))
    subscription = node.create_subscription(
        String, "news", print, 1, event_callbacks=callbacks
    )
    other = node.create_subscription(String, "news", print, 1)
    for which, count in ((subscription, 2), (other, 9), (subscription, 1)):
        graph.context.graph.message_lost(which.endpoint, count)
    graph.run_for(0.1)
    assert reported == [QoSCountInfo(2, 2), QoSCountInfo(3, 1)]


def test_event_handlers_list_the_callbacks(graph: GraphHarness) -> None:
    node = graph.add(Node("n", context=graph.context))
    publisher = node.create_publisher(
        String, "news", 1, event_callbacks=PublisherEventCallbacks(matched=print)
    )
    callbacks = SubscriptionEventCallbacks(message_lost=print, deadline=repr)
    subscription = node.create_subscription(
        String, "news", print, 1, event_callbacks=callbacks
    )
    (handler,) = publisher.event_handlers
    assert handler.event_type is QoSPublisherEventType.RCL_PUBLISHER_MATCHED
    assert handler.callback is print
    assert [each.event_type.name for each in subscription.event_handlers] == [
        "RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED",
        "RCL_SUBSCRIPTION_MESSAGE_LOST",
    ]
    assert node.create_publisher(String, "news", 1).event_handlers == []


def test_best_available_matches_every_deadline_and_lease() -> None:
    best = QoSProfile(
        depth=1,
        deadline=DeadlineBestAvailable,
        liveliness_lease_duration=LivelinessLeaseDurationeBestAvailable,
    )
    second = Duration(seconds=1)
    strict = QoSProfile(depth=1, deadline=second, liveliness_lease_duration=second)
    for publisher, subscription in ((best, strict), (strict, best), (best, best)):
        found, text = qos_check_compatible(publisher, subscription)
        assert found is QoSCompatibility.OK, text
    found, _ = qos_check_compatible(QoSProfile(depth=1), best)
    assert found is QoSCompatibility.OK
