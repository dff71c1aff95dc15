"""Subscriptions among peers that forge gids and sequence numbers."""

from collections.abc import Iterator
from typing import Any

import pytest
import zenoh
from transport_pairs import ZenohPair, message_of, until

from navette.msgs import serialize, type_hash
from navette.msgs.std_msgs.msg import String
from navette.transports import (
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    ReliabilityPolicy,
)
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.keys import data_key
from navette.transports.zenoh.sequence_filter import FAR_AHEAD

TYPE = "std_msgs/msg/String"
KEY = data_key(7, "/t", TYPE, type_hash(TYPE))
QOS = {
    "reliable": EndpointQos(),
    "best effort": EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT),
    "latched": EndpointQos.latched(),
}


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    pair = ZenohPair()
    yield pair
    pair.close()


@pytest.mark.parametrize("qos", QOS.values(), ids=list(QOS))
@pytest.mark.parametrize("number", [2**63 - 1, 2**62, FAR_AHEAD + 10])
def test_a_forged_sequence_number_does_not_block_the_publisher(
    pair: ZenohPair, qos: EndpointQos, number: int
) -> None:
    items: list[Item] = []
    subscription = Endpoint(
        EndpointKind.SUBSCRIPTION, "/t", TYPE, qos, "receiver", "/", b""
    )
    pair.near.subscribe(subscription, String, items.append, shared=False)
    endpoint = Endpoint(EndpointKind.PUBLISHER, "/t", TYPE, qos, "sender", "/", b"")
    publisher: Any = pair.far.advertise(endpoint, String)
    pair.settle()
    (seen,) = pair.near.endpoints()
    publisher.send(String(data="1"), 0, 1)
    for sequence in (2, 3):
        pair.settle()
        pair.far_zenoh.session.zenoh.put(
            KEY,
            serialize(String(data="forged")),
            attachment=Attachment(number, 0, seen.gid).encode(),
        )
        pair.settle()
        publisher.send(String(data=str(sequence)), 0, sequence)
    pair.settle()
    received = [message_of(item).data for item in items]
    assert [text for text in received if text != "forged"] == ["1", "2", "3"]


def test_far_too_long_messages_are_not_assembled() -> None:
    pair = ZenohPair(max_message_bytes=1000)
    items: list[Item] = []
    subscription = Endpoint(
        EndpointKind.SUBSCRIPTION, "/t", TYPE, EndpointQos(), "e", "/", b""
    )
    pair.near.subscribe(subscription, String, items.append, shared=False)
    sizes: list[int] = []
    pair.near_zenoh.session.zenoh.declare_subscriber(
        KEY, lambda sample: sizes.append(len(sample.payload))
    )
    pair.settle()
    publisher = pair.far_zenoh.session.zenoh.declare_publisher(
        KEY, congestion_control=zenoh.CongestionControl.BLOCK
    )
    fine = serialize(String(data="fine"))
    for payload in (bytes(3_000_000), fine):
        publisher.put(payload, attachment=Attachment(1, 0, bytes(16)).encode())
    until(lambda: len(items) == 1, "the short message")
    until(lambda: len(sizes) == 1, "the same message")
    assert sizes == [len(fine)]
    pair.close()
