"""Latched topics in one process, used by two threads at once."""

import threading

from navette.msgs.std_msgs.msg import Int64
from navette.transports import DurabilityPolicy, Endpoint, EndpointKind, EndpointQos
from navette.transports.base import Item, Sink
from navette.transports.inprocess import InProcessTransport


def endpoint(kind: EndpointKind, number: int) -> Endpoint:
    return Endpoint(
        kind,
        "/count",
        "std_msgs/msg/Int64",
        EndpointQos(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        f"node_{number}",
        "/",
        bytes([number]) * 16,
        "RIHS01_0",
    )


def test_who_joins_while_a_sample_is_delivered_receives_it_once() -> None:
    transport = InProcessTransport()
    received: list[int] = []

    def subscribe(number: int, sink: Sink) -> None:
        reader = endpoint(EndpointKind.SUBSCRIPTION, number)
        transport.subscribe(reader, Int64, sink, shared=False)

    def store(item: Item) -> None:
        received.append(item[0].data)

    def join_meanwhile(item: Item) -> None:
        if item[0].data == 2:
            other = threading.Thread(target=subscribe, args=(2, store))
            other.start()
            other.join()

    publisher = transport.advertise(endpoint(EndpointKind.PUBLISHER, 0), Int64)
    subscribe(1, join_meanwhile)
    for number in (1, 2, 3):
        publisher.send(Int64(data=number), number, number)
    assert received == [2, 3]
