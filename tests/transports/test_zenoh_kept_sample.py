"""A latched publisher without remote subscriptions serialises nothing."""

import threading
from typing import Any

import pytest
import zenoh
from transport_pairs import LIMIT_S, ZenohPair, message_of, until
from zenoh import ext

from navette.msgs import serialize
from navette.msgs.std_msgs.msg import String
from navette.transports import (
    Encoded,
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    PublisherPort,
    SubscriptionPort,
)
from navette.transports.zenoh import kept_sample
from navette.transports.zenoh.attachment import decode_attachment

LATCHED = EndpointQos.latched(1)
DEEPER = EndpointQos.latched(5)
VOLATILE = EndpointQos()
KEY = "7/map/std_msgs::msg::dds_::String_/*"  # any type hash


class Serialized:
    """Records what is serialised, and makes that wait on demand."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self.may_proceed = threading.Event()
        self.may_proceed.set()

    def serialize(self, message: Any) -> bytes:
        self.texts.append(message.data)
        assert self.may_proceed.wait(LIMIT_S)
        return serialize(message)


@pytest.fixture
def serialized(monkeypatch: pytest.MonkeyPatch) -> Serialized:
    record = Serialized()
    monkeypatch.setattr(kept_sample, "serialize", record.serialize)
    return record


def endpoint(kind: EndpointKind, qos: EndpointQos, node: str) -> Endpoint:
    return Endpoint(kind, "/map", "std_msgs/msg/String", qos, node, "/", b"")


def publisher(pair: ZenohPair, qos: EndpointQos = LATCHED) -> PublisherPort:
    port = pair.near.advertise(endpoint(EndpointKind.PUBLISHER, qos, "mapper"), String)
    pair.settle()
    return port


def subscribe(
    pair: ZenohPair, qos: EndpointQos = LATCHED, node: str = "reader"
) -> tuple[list[Item], SubscriptionPort]:
    items: list[Item] = []
    end = endpoint(EndpointKind.SUBSCRIPTION, qos, node)
    return items, pair.far.subscribe(end, String, items.append, shared=False)


def hand_over(port: PublisherPort, *numbers: int) -> None:
    for number in numbers:
        port.hand_over(String(data=f"m{number}"), 100 * number, number)


def texts(items: list[Item]) -> list[str]:
    return [message_of(item).data for item in items]


class ForeignReader:
    """A transient-local subscription of zenoh-ext, as rmw_zenoh has it.

    Unlike Navette's, it does not drop samples that are late or come again.
    """

    def __init__(self, pair: ZenohPair, depth: int) -> None:
        self.numbers: list[int] = []
        self._subscriber: Any = ext.declare_advanced_subscriber(
            pair.far_zenoh.session.zenoh,
            KEY,
            zenoh.handlers.Callback(self._on_sample, indirect=False),
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=depth),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
        )

    def _on_sample(self, sample: zenoh.Sample) -> None:
        attachment = sample.attachment
        assert attachment is not None
        self.numbers.append(decode_attachment(attachment.to_bytes()).sequence)


def test_nothing_is_serialised_before_a_late_joiner_queries(
    pair: ZenohPair, serialized: Serialized
) -> None:
    port = publisher(pair)
    local = endpoint(EndpointKind.SUBSCRIPTION, LATCHED, "local")
    pair.near.subscribe(local, String, lambda _: None, shared=True)
    hand_over(port, 1, 2, 3)
    pair.settle()
    assert serialized.texts == []
    items, _ = subscribe(pair)
    until(lambda: len(items) == 1, "the history")
    pair.settle()
    assert texts(items) == ["m3"]
    assert items[0][1::2] == (300, 3), "stamp and sequence are of the publication"
    assert serialized.texts == ["m3"]


def test_edits_after_a_plain_send_are_not_seen(pair: ZenohPair) -> None:
    port = publisher(pair)
    message = String(data="before")
    port.send(message, 0, 1)
    message.data = "after"
    items, _ = subscribe(pair)
    until(lambda: len(items) == 1, "the history")
    assert texts(items) == ["before"]


def test_a_volatile_late_joiner_receives_only_what_follows(pair: ZenohPair) -> None:
    port = publisher(pair)
    hand_over(port, 1)
    volatile, _ = subscribe(pair, VOLATILE)
    pair.settle()
    latched, _ = subscribe(pair, DEEPER)
    until(lambda: len(latched) == 1, "the history")
    pair.settle()
    assert volatile == []
    hand_over(port, 2, 3)
    until(lambda: len(volatile) == 2, "the live samples")
    until(lambda: len(latched) == 3, "the live samples")
    assert (texts(volatile), texts(latched)) == (["m2", "m3"], ["m1", "m2", "m3"])


def test_recovery_does_not_fetch_the_kept_sample() -> None:
    pair = ZenohPair(retransmit=("*",))
    try:
        port = publisher(pair)
        hand_over(port, 1)
        volatile, _ = subscribe(pair, VOLATILE)
        pair.settle()
        hand_over(port, 2)
        until(lambda: len(volatile) == 1, "the live sample")
        pair.settle()
        assert texts(volatile) == ["m2"]
    finally:
        pair.close()


def test_a_peer_may_query_the_publishers_of_a_session(pair: ZenohPair) -> None:
    """As zenoh-ros2-sdk does, which does not look for the publishers' tokens."""
    hand_over(publisher(pair), 1)
    pair.settle()
    selector = f"{KEY}/@adv/pub/{pair.near_zenoh.session.zid}/**?_anyke;_max=1"
    replies = list(pair.far_zenoh.session.zenoh.get(selector, timeout=LIMIT_S))
    payloads = [reply.ok.payload.to_bytes() for reply in replies if reply.ok]
    assert payloads == [serialize(String(data="m1"))]


def test_later_joiners_receive_the_newest_sample(pair: ZenohPair) -> None:
    port = publisher(pair)
    hand_over(port, 1)
    first, _ = subscribe(pair)
    second, port_of_second = subscribe(pair, DEEPER)
    until(lambda: (len(first), len(second)) == (1, 1), "the history")
    hand_over(port, 2)
    until(lambda: (len(first), len(second)) == (2, 2), "the live sample")
    port_of_second.close()
    third, _ = subscribe(pair, DEEPER)
    until(lambda: len(third) == 1, "the history")
    pair.settle()
    assert (texts(second), texts(third)) == (["m1", "m2"], ["m2"])


def test_a_subscriber_whose_token_is_unread_receives_the_samples(
    pair: ZenohPair,
) -> None:
    port = publisher(pair)
    hand_over(port, 1)
    with pair.near_zenoh.session.graph._lock:  # the publisher's graph cannot change
        latched, _ = subscribe(pair)
        until(lambda: len(latched) == 1, "the history")
        volatile, _ = subscribe(pair, VOLATILE)
        hand_over(port, 2)
        until(lambda: (len(latched), len(volatile)) == (2, 1), "the live sample")
    assert (texts(latched), texts(volatile)) == (["m1", "m2"], ["m2"])


@pytest.mark.parametrize("depth", [1, 5])
def test_samples_published_during_a_reply_follow_the_kept_one(
    pair: ZenohPair, serialized: Serialized, depth: int
) -> None:
    port = publisher(pair)
    hand_over(port, 1)
    serialized.may_proceed.clear()
    reader = ForeignReader(pair, depth)
    until(lambda: serialized.texts == ["m1"], "the reply")
    for number in (2, 3):
        port.send(Encoded(serialize(String(data="")), String, print), 0, number)
    serialized.may_proceed.set()
    until(lambda: reader.numbers[-1:] == [3], "the newest sample")
    pair.settle()
    hand_over(port, 4)
    until(lambda: reader.numbers[-1:] == [4], "the live sample")
    # Decision 0018: with more than one, what follows the kept sample may begin late.
    begins_late = depth > 1 and 2 not in reader.numbers
    assert reader.numbers == ([1, 3, 4] if begins_late else [1, 2, 3, 4])


class Loop:
    """Hands over samples in a thread until it is left."""

    def __init__(self, port: PublisherPort) -> None:
        self.last = 0
        self._port = port
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> "Loop":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._is_over.set()
        self._thread.join()

    def _run(self) -> None:
        # Pauses let the thread run that sends what was published during a reply; of
        # more than ten samples it drops the oldest.
        while not self._is_over.wait(1e-4):
            self.last += 1
            hand_over(self._port, self.last)


def test_samples_arrive_once_and_in_order_while_subscribers_join(
    pair: ZenohPair,
) -> None:
    with Loop(publisher(pair)) as loop:
        until(lambda: loop.last > 10, "the first samples")
        foreign, deeper = ForeignReader(pair, 1), ForeignReader(pair, 5)
        volatile, _ = subscribe(pair, VOLATILE)
        until(lambda: len(foreign.numbers) > 100, "the samples")
        until(lambda: len(deeper.numbers) > 100, "the samples")
        until(lambda: len(volatile) > 100, "the samples")
    until(lambda: foreign.numbers[-1] == loop.last, "the last sample")
    until(lambda: deeper.numbers[-1] == loop.last, "the last sample")
    until(lambda: volatile[-1][3] == loop.last, "the last sample")
    live = [item[3] for item in volatile]
    assert live == list(range(live[0], loop.last + 1))
    # Decision 0018: what follows the kept sample may begin late.
    for numbers in (foreign.numbers, deeper.numbers):
        assert numbers == sorted(set(numbers))


def test_a_closed_publisher_keeps_nothing(pair: ZenohPair) -> None:
    port = publisher(pair)
    hand_over(port, 1)
    port.close()
    hand_over(port, 2)
    items, _ = subscribe(pair)
    pair.settle()
    assert items == []


def test_a_message_that_cannot_be_serialised_is_logged(
    pair: ZenohPair, caplog: pytest.LogCaptureFixture
) -> None:
    port = publisher(pair)
    port.hand_over(String(data="\ud800"), 0, 1)
    items, _ = subscribe(pair)
    until(lambda: "the kept message cannot be sent" in caplog.text, "the warning")
    hand_over(port, 2)
    until(lambda: texts(items) == ["m2"], "the live sample")


def test_an_error_in_a_reply_does_not_hold_up_what_follows(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = threading.Event()

    def fail(_: object) -> bytes:
        asked.set()
        raise ZeroDivisionError

    monkeypatch.setattr(kept_sample, "serialize", fail)
    port = publisher(pair)
    hand_over(port, 1)
    items, _ = subscribe(pair)
    assert asked.wait(LIMIT_S)
    hand_over(port, 2)
    until(lambda: texts(items) == ["m2"], "the live sample")
