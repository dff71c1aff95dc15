"""Lifespans, deadlines and leases, the same in process and between processes."""

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from transport_benches import free_endpoint, until

from navette import Context, DurabilityPolicy, Node, QoSProfile
from navette.msgs.std_msgs.msg import String
from navette.runtime import Duration, Executor, Subscription, VirtualClock
from navette.runtime.context import new_graph

STEP_NS = 10_000_000


class Ends:
    """Two nodes on one virtual time: of one process, or met over a network."""

    def __init__(self, stack: ExitStack, *, over_zenoh: bool) -> None:
        self.clock = VirtualClock()
        self._stack = stack
        self._over_zenoh = over_zenoh
        self._shared = new_graph()
        stack.callback(self._shared.close)
        self._executors: list[Executor] = []
        self.near, self.far = self.node("near"), self.node("far")

    def node(self, name: str, clock: Any = None) -> Node:
        where: dict[str, Any] = {"graph": self._shared}
        if self._over_zenoh:
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
    """Wait until so many samples are in the queue, before any of them is taken."""
    until(lambda: len(subscription._queue) == count, f"{count} samples")


def news(latched: bool) -> QoSProfile:
    durability = DurabilityPolicy.VOLATILE
    if latched:
        durability = DurabilityPolicy.TRANSIENT_LOCAL
    return QoSProfile(depth=5, durability=durability, lifespan=Duration(seconds=1))


@pytest.mark.parametrize("latched", [False, True])
def test_what_expires_in_the_queue_is_dropped(ends: Ends, latched: bool) -> None:
    heard: list[str] = []
    publisher = ends.near.create_publisher(String, "/news", news(latched))
    subscription = ends.far.create_subscription(
        String, "/news", lambda m: heard.append(m.data), 10
    )
    until(lambda: publisher.get_subscription_count() == 1, "the match")
    ends.clock.now_ns = 5_000_000_000
    publisher.publish(String(data="old"))
    ends.clock.now_ns += 900_000_000
    publisher.publish(String(data="young"))
    arrived(subscription, 2)
    ends.clock.now_ns += 200_000_000
    ends.pass_time(0.01)
    assert heard == ["young"]


def test_late_joiners_get_no_expired_samples(ends: Ends) -> None:
    publisher = ends.near.create_publisher(String, "/news", news(latched=True))
    publisher.publish(String(data="old"))
    ends.pass_time(0.6)
    publisher.publish(String(data="young"))
    ends.pass_time(0.6)
    heard: list[str] = []
    subscription = ends.far.create_subscription(
        String, "/news", lambda m: heard.append(m.data), news(latched=True)
    )
    arrived(subscription, 2)
    ends.pass_time(0.01)
    assert heard == ["young"]


def test_a_publisher_that_is_not_known_yet_has_a_lifespan_all_the_same(
    ends: Ends,
) -> None:
    """Made after the subscription: its samples may be faster than its token."""
    heard: list[str] = []
    subscription = ends.far.create_subscription(
        String, "/news", lambda m: heard.append(m.data), news(latched=True)
    )
    publisher = ends.near.create_publisher(String, "/news", news(latched=True))
    publisher.publish(String(data="old"))
    arrived(subscription, 1)
    until(lambda: subscription.get_publisher_count() == 1, "the match")
    ends.pass_time(1.0)
    assert heard == ["old"]
    publisher.publish(String(data="older"))
    arrived(subscription, 1)
    ends.clock.now_ns += 1_000_000_000
    ends.pass_time(0.01)
    assert heard == ["old"]
