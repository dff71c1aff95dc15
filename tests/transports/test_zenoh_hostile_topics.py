"""Listeners among those who use others' names, and numbers as they like."""

from collections.abc import Iterator
from typing import Any

import pytest
from transport_benches import ZenohPair, message_of, until

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
def test_a_number_in_anothers_name_does_not_shut_it_out(
    pair: ZenohPair, qos: EndpointQos, number: int
) -> None:
    items: list[Item] = []
    ear = Endpoint(EndpointKind.SUBSCRIPTION, "/t", TYPE, qos, "ear", "/", b"")
    pair.near.subscribe(ear, String, items.append, shared=False)
    mouth = Endpoint(EndpointKind.PUBLISHER, "/t", TYPE, qos, "mouth", "/", b"")
    publisher: Any = pair.far.advertise(mouth, String)
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
    heard = [message_of(item).data for item in items]
    assert [text for text in heard if text != "forged"] == ["1", "2", "3"]


def test_what_is_far_too_long_is_not_even_put_together() -> None:
    pair = ZenohPair(max_message_bytes=1000)
    items: list[Item] = []
    ear = Endpoint(EndpointKind.SUBSCRIPTION, "/t", TYPE, EndpointQos(), "e", "/", b"")
    pair.near.subscribe(ear, String, items.append, shared=False)
    sizes: list[int] = []
    pair.near_zenoh.session.zenoh.declare_subscriber(
        KEY, lambda sample: sizes.append(len(sample.payload))
    )
    pair.settle()
    publisher = pair.far_zenoh.session.zenoh.declare_publisher(KEY)
    fine = serialize(String(data="fine"))
    for payload in (bytes(3_000_000), fine):
        publisher.put(payload, attachment=Attachment(1, 0, bytes(16)).encode())
    until(lambda: len(items) == 1, "what is not too long")
    until(lambda: len(sizes) == 1, "the same")
    assert sizes == [len(fine)]
    pair.close()
