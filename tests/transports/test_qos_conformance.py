"""Lifespans, deadlines and leases, in process and between processes."""

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from transport_pairs import until

from free_ports import free_endpoint
from navette import Context, DurabilityPolicy, Node, QoSProfile
from navette.msgs.std_msgs.msg import String
from navette.runtime import (
    Duration,
    Executor,
    LivelinessPolicy,
    Subscription,
    VirtualClock,
)
from navette.runtime.context import new_graph
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    QoSCountInfo,
    QoSLivelinessChangedInfo,
    SubscriptionEventCallbacks,
)

Changed = QoSLivelinessChangedInfo
STEP_NS = 10_000_000


class Ends:
    """Two nodes on one virtual time, in one process or over a network."""

    def __init__(self, stack: ExitStack, *, over_zenoh: bool) -> None:
        self.clock = VirtualClock()
        self._stack = stack
        self.over_zenoh = over_zenoh
        self._shared = new_graph()
        stack.callback(self._shared.close)
        self._executors: list[Executor] = []
        self.near, self.far = self.node("near"), self.node("far")

    def node(self, name: str, clock: Any = None) -> Node:
        where: dict[str, Any] = {"graph": self._shared}
        if self.over_zenoh:
            where = {"transport": "zenoh"}
        context = self._stack.enter_context(Context(clock=clock or self.clock, **where))
        node = Node(name, context=context)
        self._executors.append(Executor(context=context))
        self._executors[-1].add_node(node)
        return node

    def pass_time(self, seconds: float) -> None:
        end_ns = self.clock.now_ns + round(seconds * 1e9)
        while self.clock.now_ns < end_ns:
            step_end_ns = min(self.clock.now_ns + STEP_NS, end_ns)
            for executor in self._executors:
                executor.spin_until(step_end_ns)


@pytest.fixture(params=["in-process", "zenoh"])
def ends(request: pytest.FixtureRequest, monkeypatch: Any) -> Iterator[Ends]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    with ExitStack() as stack:
        yield Ends(stack, over_zenoh=request.param == "zenoh")


def arrived(subscription: Subscription[Any], count: int) -> None:
    """Wait until ``count`` samples are queued, before any of them is taken."""
    until(lambda: len(subscription._queue) == count, f"{count} samples")


def news(latched: bool) -> QoSProfile:
    durability = DurabilityPolicy.VOLATILE
    if latched:
        durability = DurabilityPolicy.TRANSIENT_LOCAL
    return QoSProfile(depth=5, durability=durability, lifespan=Duration(seconds=1))


@pytest.mark.parametrize("latched", [False, True])
def test_samples_that_expire_in_a_queue_are_dropped(ends: Ends, latched: bool) -> None:
    received: list[str] = []
    publisher = ends.near.create_publisher(String, "/news", news(latched))
    subscription = ends.far.create_subscription(
        String, "/news", lambda m: received.append(m.data), 10
    )
    until(lambda: publisher.get_subscription_count() == 1, "the match")
    until(lambda: subscription.get_publisher_count() == 1, "the match")
    ends.clock.now_ns = 5_000_000_000
    publisher.publish(String(data="old"))
    ends.clock.now_ns += 900_000_000
    publisher.publish(String(data="young"))
    arrived(subscription, 2)
    ends.clock.now_ns += 200_000_000
    ends.pass_time(0.01)
    assert received == ["young"]


def test_late_joiners_get_no_expired_samples(ends: Ends) -> None:
    publisher = ends.near.create_publisher(String, "/news", news(latched=True))
    publisher.publish(String(data="old"))
    ends.pass_time(0.6)
    publisher.publish(String(data="young"))
    ends.pass_time(0.6)
    received: list[str] = []
    subscription = ends.far.create_subscription(
        String, "/news", lambda m: received.append(m.data), news(latched=True)
    )
    arrived(subscription, 2)
    until(lambda: subscription.get_publisher_count() == 1, "the match")
    ends.pass_time(0.01)
    assert received == ["young"]


def test_the_lifespan_applies_before_the_publisher_is_known(
    ends: Ends,
) -> None:
    """The samples of a new publisher may be faster than its token."""
    received: list[str] = []
    subscription = ends.far.create_subscription(
        String, "/news", lambda m: received.append(m.data), news(latched=True)
    )
    publisher = ends.near.create_publisher(String, "/news", news(latched=True))
    publisher.publish(String(data="old"))
    arrived(subscription, 1)
    until(lambda: subscription.get_publisher_count() == 1, "the match")
    ends.pass_time(1.0)
    assert received == ["old"]
    publisher.publish(String(data="older"))
    arrived(subscription, 1)
    ends.clock.now_ns += 1_000_000_000
    ends.pass_time(0.01)
    assert received == ["old"]


def test_deadlines_of_both_ends(ends: Ends) -> None:
    qos = QoSProfile(depth=10, deadline=Duration(seconds=0.6))
    offered: list[Any] = []
    requested: list[Any] = []
    publisher = ends.near.create_publisher(
        String,
        "/t",
        qos,
        event_callbacks=PublisherEventCallbacks(deadline=offered.append),
    )
    subscription = ends.far.create_subscription(
        String,
        "/t",
        lambda m: None,
        qos,
        event_callbacks=SubscriptionEventCallbacks(deadline=requested.append),
    )
    until(lambda: publisher.get_subscription_count() == 1, "the match")
    ends.pass_time(2.0)
    assert offered == requested == []  # deadlines begin with the first message
    for _ in range(2):
        publisher.publish(String())
        arrived(subscription, 1)
        ends.pass_time(0.5)
    assert offered == requested == []
    ends.pass_time(0.4)
    missed = [QoSCountInfo(1, 1), QoSCountInfo(2, 1)]
    assert offered == requested == missed[:1]
    ends.pass_time(0.4)
    assert offered == requested == missed
    publisher.publish(String())
    arrived(subscription, 1)
    ends.pass_time(0.5)
    assert offered == requested == missed


class Manual:
    """A MANUAL_BY_TOPIC publisher and the liveliness events of a subscription."""

    def __init__(self, ends: Ends, lease_s: float = 1.0, **qos: Any) -> None:
        self.ends = ends
        self.qos = QoSProfile(
            depth=10,
            liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
            liveliness_lease_duration=Duration(seconds=lease_s),
            **qos,
        )
        self.matched: list[Any] = []
        callbacks = PublisherEventCallbacks(matched=self.matched.append)
        self.publisher = ends.near.create_publisher(
            String, "/t", self.qos, event_callbacks=callbacks
        )
        self.subscription, self.changes = self.subscribe()

    def subscribe(self) -> tuple[Subscription[Any], list[Changed]]:
        changes: list[Changed] = []
        subscription = self.ends.far.create_subscription(
            String,
            "/t",
            lambda m: None,
            self.qos,
            event_callbacks=SubscriptionEventCallbacks(liveliness=changes.append),
        )
        until(lambda: subscription.get_publisher_count() == 1, "the match")
        until(lambda: self.publisher.get_subscription_count() >= 1, "the match")
        return subscription, changes

    def publish(self) -> None:
        self.publisher.publish(String())
        arrived(self.subscription, 1)


def test_messages_keep_a_manual_publisher_alive(ends: Ends) -> None:
    manual = Manual(ends)
    ends.pass_time(3.0)
    assert manual.changes == []  # no message yet
    for _ in range(3):
        manual.publish()
        ends.pass_time(0.9)
    assert manual.changes == [Changed(1, 0, 1, 0)]
    _, late = manual.subscribe()
    ends.pass_time(0.09)
    assert late == [Changed(1, 0, 1, 0)]  # known to be alive
    ends.pass_time(0.1)
    lapsed = Changed(0, 1, -1, 1)
    assert (manual.changes[1:], late[1:]) == ([lapsed], [lapsed])
    ends.pass_time(5.0)
    manual.publish()
    ends.pass_time(0.1)
    assert manual.changes[2:] == [Changed(1, 0, 1, -1)]
    manual.publisher.destroy()
    until(lambda: manual.subscription.get_publisher_count() == 0, "the unmatch")
    ends.pass_time(3.0)
    assert manual.changes[3:] == [Changed(0, 0, -1, 0)]


def test_a_publisher_that_closes_while_not_alive_is_not_counted(
    ends: Ends,
) -> None:
    manual = Manual(ends)
    manual.publish()
    ends.pass_time(2.0)
    manual.publisher.destroy()
    until(lambda: manual.subscription.get_publisher_count() == 0, "the unmatch")
    ends.pass_time(0.1)
    assert manual.changes[-1] == Changed(0, 0, 0, -1)


def test_history_does_not_assert_liveliness(ends: Ends) -> None:
    """The publisher of samples kept for late joiners may hang meanwhile."""
    manual = Manual(ends, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    manual.publish()
    ends.pass_time(2.0)
    late, changes = manual.subscribe()
    arrived(late, 1)
    ends.pass_time(0.1)
    assert changes == []


def test_assertions_without_messages_keep_a_publisher_alive(ends: Ends) -> None:
    manual = Manual(ends)
    ends.pass_time(0.1)

    def has_matched() -> bool:
        ends.pass_time(0.01)
        return bool(manual.matched)

    until(has_matched, "the match")
    until(lambda: manual.subscription.get_publisher_count() == 1, "the match")
    logged: list[str] = []
    ends.near.context.log.sinks.append(lambda record: logged.append(record.message))
    received: list[Any] = []
    ends.far.context.graph.on_assertion("/t", lambda *ends: received.append(ends))
    for count in (1, 2, 3):
        manual.publisher.assert_liveliness()
        if ends.over_zenoh:
            until(lambda count=count: len(received) == count, "the assertion")  # type: ignore[misc]
        ends.pass_time(0.9)
    assert manual.changes == [Changed(1, 0, 1, 0)]
    ends.pass_time(0.2)
    assert manual.changes[1:] == [Changed(0, 1, -1, 1)]
    assert logged == []
