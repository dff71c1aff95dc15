"""Conformance suite for topics, run with every transport."""

from collections.abc import Iterator
from typing import Any

import pytest
from transport_pairs import PAIRS, InProcessPair, Pair, message_of, until

from navette.errors import InvalidValueError
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import Float64, String
from navette.transports import (
    DurabilityPolicy,
    Endpoint,
    EndpointKind,
    EndpointQos,
    HistoryPolicy,
    Item,
    PublisherPort,
    QoSPolicyKind,
    ReliabilityPolicy,
    SubscriptionPort,
    TransportObserver,
)

LATCHED = EndpointQos(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT)
BEST_AVAILABLE = EndpointQos(depth=3, durability=DurabilityPolicy.BEST_AVAILABLE)


class Bench:
    """Opens publishers at one end and subscriptions at the other; records samples."""

    def __init__(self, pair: Pair) -> None:
        self.pair = pair
        self.settle = pair.settle
        self._count = 0

    def _endpoint(
        self, kind: EndpointKind, topic: str, type_name: str, qos: EndpointQos
    ) -> Endpoint:
        self._count += 1
        gid = self._count.to_bytes(16, "big")
        return Endpoint(kind, topic, type_name, qos, f"n{self._count}", "/", gid)

    def publisher(
        self,
        topic: str = "/t",
        *,
        qos: EndpointQos | None = None,
        cls: type = String,
        type_name: str = "std_msgs/msg/String",
    ) -> PublisherPort:
        kind = EndpointKind.PUBLISHER
        endpoint = self._endpoint(kind, topic, type_name, qos or EndpointQos())
        port = self.pair.near.advertise(endpoint, cls)
        self.settle()
        return port

    def subscription(
        self,
        topic: str = "/t",
        *,
        qos: EndpointQos | None = None,
        shared: bool = False,
        cls: type = String,
        type_name: str = "std_msgs/msg/String",
    ) -> tuple[list[Item], SubscriptionPort]:
        items: list[Item] = []
        kind = EndpointKind.SUBSCRIPTION
        endpoint = self._endpoint(kind, topic, type_name, qos or EndpointQos())
        port = self.pair.far.subscribe(endpoint, cls, items.append, shared=shared)
        self.settle()
        return items, port


@pytest.fixture(params=list(PAIRS))
def bench(request: pytest.FixtureRequest) -> Iterator[Bench]:
    pair = PAIRS[request.param]()
    yield Bench(pair)
    pair.close()


@pytest.fixture
def local_bench() -> Iterator[Bench]:
    pair = InProcessPair()
    yield Bench(pair)
    pair.close()


def texts(items: list[Item]) -> list[str]:
    return [message_of(item).data for item in items]


def test_samples_arrive_in_order_with_stamp_and_sequence(bench: Bench) -> None:
    items, _ = bench.subscription()
    publisher = bench.publisher()
    for number in (1, 2, 3):
        publisher.send(String(data=f"m{number}"), 100 * number, number)
    bench.settle()
    assert texts(items) == ["m1", "m2", "m3"]
    assert [(item[1], item[3]) for item in items] == [(100, 1), (200, 2), (300, 3)]


def test_every_subscription_of_the_topic_receives_a_sample(bench: Bench) -> None:
    first, _ = bench.subscription()
    second, _ = bench.subscription()
    other, _ = bench.subscription("/other")
    bench.publisher().send(String(data="x"), 0, 1)
    bench.settle()
    assert (texts(first), texts(second), other) == (["x"], ["x"], [])


def test_later_changes_by_the_publisher_have_no_effect(bench: Bench) -> None:
    copied, _ = bench.subscription()
    shared, _ = bench.subscription(shared=True)
    message = String(data="before")
    bench.publisher().send(message, 0, 1)
    message.data = "after"
    bench.settle()
    assert (texts(copied), texts(shared)) == (["before"], ["before"])


def test_changes_by_a_subscriber_do_not_reach_others(bench: Bench) -> None:
    first, _ = bench.subscription()
    second, _ = bench.subscription()
    shared, _ = bench.subscription(shared=True)
    bench.publisher().send(String(data="x"), 0, 1)
    bench.settle()
    message_of(first[0]).data = "mine"
    assert (texts(second), texts(shared)) == (["x"], ["x"])


def test_arrays_are_not_shared_between_copies(bench: Bench) -> None:
    kind: dict[str, Any] = {
        "cls": OccupancyGrid,
        "type_name": "nav_msgs/msg/OccupancyGrid",
    }
    first, _ = bench.subscription(**kind)
    second, _ = bench.subscription(**kind)
    grid = OccupancyGrid(data=[1, 2, 3])
    bench.publisher(**kind).send(grid, 0, 1)
    grid.data[0] = 9
    bench.settle()
    message_of(first[0]).data[1] = 9
    assert list(message_of(second[0]).data) == [1, 2, 3]


def test_a_late_joiner_receives_the_last_depth_samples(bench: Bench) -> None:
    publisher = bench.publisher(qos=LATCHED)
    for number in range(1, 6):
        publisher.send(String(data=f"m{number}"), number, number)
    bench.settle()  # decision 0018: a history may begin late while its publisher is new
    all_kept, _ = bench.subscription(qos=LATCHED)
    one_only = EndpointQos.latched(1)
    newest, _ = bench.subscription(qos=one_only)
    shared, _ = bench.subscription(qos=LATCHED, shared=True)
    volatile, _ = bench.subscription()
    either, _ = bench.subscription(qos=BEST_AVAILABLE)
    received = (all_kept, shared, either, newest)
    until(lambda: [len(each) for each in received] == [3, 3, 3, 1], "the history")
    bench.settle()
    assert texts(all_kept) == ["m3", "m4", "m5"]
    assert texts(shared) == ["m3", "m4", "m5"]
    assert texts(either) == ["m3", "m4", "m5"]
    assert texts(newest) == ["m5"]
    # Recovery fetches what was published up to half a second before, too.
    assert bench.pair.retransmits or volatile == []


@pytest.mark.parametrize("depth", [1, 3])
def test_a_late_joiner_receives_the_last_handed_over_samples(
    bench: Bench, depth: int
) -> None:
    qos = EndpointQos.latched(depth)
    publisher = bench.publisher(qos=qos)
    for number in range(1, 6):
        publisher.hand_over(String(data=f"m{number}"), 10 * number, number)
    bench.settle()
    volatile, _ = bench.subscription()
    latched, _ = bench.subscription(qos=qos)
    until(lambda: len(latched) == depth, "the history")
    publisher.hand_over(String(data="m6"), 60, 6)
    until(lambda: len(latched) == depth + 1, "the live sample")
    bench.settle()
    numbers = range(6 - depth, 7)
    assert texts(latched) == [f"m{number}" for number in numbers]
    assert [item[1] for item in latched] == [10 * number for number in numbers]
    # Recovery fetches what was published up to half a second before, too.
    assert bench.pair.retransmits or texts(volatile) == ["m6"]


def test_latched_samples_are_copies(bench: Bench) -> None:
    publisher = bench.publisher(qos=LATCHED)
    message = String(data="before")
    publisher.send(message, 0, 1)
    message.data = "after"
    first, _ = bench.subscription(qos=LATCHED)
    until(lambda: len(first) == 1, "the history")
    message_of(first[0]).data = "mine"
    second, _ = bench.subscription(qos=LATCHED)
    until(lambda: texts(second) == ["before"], "the history")


def test_keep_all_keeps_all(bench: Bench) -> None:
    qos = EndpointQos(
        history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )
    publisher = bench.publisher(qos=qos)
    for number in range(100):
        publisher.send(String(data=str(number)), 0, number + 1)
    kept = [str(number) for number in range(100)]
    for _ in range(5):  # decision 0018: a history may begin late
        items, _ = bench.subscription(qos=qos)
        until(lambda items=items: texts(items)[-1:] == kept[-1:], "the history")
        bench.settle()
        if texts(items) == kept:
            break
        assert texts(items) == kept[-len(items) :], "nothing is lost in between"
    assert texts(items) == kept


@pytest.mark.parametrize(
    ("offered", "requested", "kind"),
    [
        (BEST_EFFORT, EndpointQos(), QoSPolicyKind.RELIABILITY),
        (EndpointQos(), LATCHED, QoSPolicyKind.DURABILITY),
        (EndpointQos(), EndpointQos(deadline_ns=10), QoSPolicyKind.DEADLINE),
    ],
)
def test_incompatible_qos_is_reported_and_does_not_match(
    bench: Bench, offered: EndpointQos, requested: EndpointQos, kind: QoSPolicyKind
) -> None:
    reports: list[tuple[str, str, tuple[QoSPolicyKind, ...]]] = []

    class Observer(TransportObserver):
        def incompatible_qos(
            self,
            publisher: Endpoint,
            subscription: Endpoint,
            policies: tuple[QoSPolicyKind, ...],
        ) -> None:
            reports.append((publisher.node_name, subscription.node_name, policies))

    bench.pair.observe(Observer())
    publisher = bench.publisher(qos=offered)
    items, port = bench.subscription(qos=requested)
    publisher.send(String(data="x"), 0, 1)
    bench.settle()
    assert items == []
    assert (publisher.matched_count, port.matched_count) == (0, 0)
    assert reports == [("n1", "n2", (kind,))]


def test_reliable_offer_satisfies_best_effort_request(bench: Bench) -> None:
    publisher = bench.publisher()
    items, _ = bench.subscription(qos=BEST_EFFORT)
    publisher.send(String(data="x"), 0, 1)
    bench.settle()
    assert texts(items) == ["x"]


def test_another_type_on_the_topic_is_an_error_that_names_both(
    local_bench: Bench,
) -> None:
    local_bench.publisher()
    with pytest.raises(InvalidValueError, match=r"/t has the type std_msgs.*n1"):
        local_bench.subscription(cls=Float64, type_name="std_msgs/msg/Float64")


def test_a_topic_without_endpoints_can_get_another_type(bench: Bench) -> None:
    bench.publisher().close()
    items, _ = bench.subscription(cls=Float64, type_name="std_msgs/msg/Float64")
    publisher = bench.publisher(cls=Float64, type_name="std_msgs/msg/Float64")
    publisher.send(Float64(data=1.5), 0, 1)
    bench.settle()
    assert message_of(items[0]).data == 1.5


def test_closed_ports_neither_send_nor_receive(bench: Bench) -> None:
    publisher = bench.publisher()
    gone, gone_port = bench.subscription()
    stays, stays_port = bench.subscription()
    gone_port.close()
    gone_port.close()
    publisher.send(String(data="a"), 0, 1)
    publisher.close()
    publisher.send(String(data="b"), 0, 2)
    bench.settle()
    assert (gone, texts(stays)) == ([], ["a"])
    assert (publisher.matched_count, stays_port.matched_count) == (0, 0)


def test_the_graph_lists_endpoints_and_reports_changes(local_bench: Bench) -> None:
    events: list[str] = []

    class Observer(TransportObserver):
        def graph_changed(self) -> None:
            events.append("changed")

        def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
            events.append(f"{publisher.node_name}>{subscription.node_name}")

        def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
            events.append(f"{publisher.node_name}|{subscription.node_name}")

    local_bench.pair.observe(Observer())
    publisher = local_bench.publisher()
    _, port = local_bench.subscription()
    names = [(e.node_name, e.kind, e.topic) for e in local_bench.pair.endpoints()]
    assert names == [
        ("n1", EndpointKind.PUBLISHER, "/t"),
        ("n2", EndpointKind.SUBSCRIPTION, "/t"),
    ]
    port.close()
    publisher.close()
    assert local_bench.pair.endpoints() == []
    assert events == ["changed", "n1>n2", "changed", "n1|n2", "changed", "changed"]


# With retransmission every sample is serialised, for the publisher's cache.
@pytest.mark.parametrize("bench", ["in-process", "zenoh"], indirect=True)
def test_messages_without_a_subscription_are_not_serialised(bench: Bench) -> None:
    class Loud:
        def __getattr__(self, name: str) -> Any:
            raise AssertionError("the message was serialised")

    bench.publisher().send(Loud(), 0, 1)
