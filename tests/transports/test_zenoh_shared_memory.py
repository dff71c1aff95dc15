"""Long messages between two sessions: through shared memory, complete, in order."""

import threading
from collections.abc import Iterator

import pytest
import zenoh
from transport_pairs import ZenohPair, message_of, until

from navette.msgs import serialize
from navette.msgs.sensor_msgs.msg import Image
from navette.transports import Endpoint, EndpointKind, EndpointQos, Item
from navette.transports.qos import HistoryPolicy
from navette.transports.zenoh.shared_memory import MIN_BYTES, SharedPools, copied

IMAGE = "sensor_msgs/msg/Image"
# What finds no place in shared memory goes through the socket, where a message of
# 20 MB that keeps the last is dropped if the other end is halted for 0.2 s.
LOSSLESS = EndpointQos(HistoryPolicy.KEEP_ALL)
SIZES = [MIN_BYTES // 2, MIN_BYTES, 1 << 20, 3 << 20, 9 << 20, 20 << 20, 100]


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    pair = ZenohPair()
    yield pair
    pair.close()


def end(kind: EndpointKind) -> Endpoint:
    return Endpoint(kind, "/image", IMAGE, LOSSLESS, "n", "/", b"")


def an_image(size: int) -> Image:
    data = bytes(range(256)) * (size // 256 + 1)
    return Image(height=1, width=size, step=size, encoding="mono8", data=data[:size])


def test_images_of_every_size_arrive_in_order(pair: ZenohPair) -> None:
    items: list[Item] = []
    pair.far.subscribe(
        end(EndpointKind.SUBSCRIPTION), Image, items.append, shared=False
    )
    publisher = pair.near.advertise(end(EndpointKind.PUBLISHER), Image)
    pair.settle()
    sizes = SIZES * 3  # also before the pools are open
    for number, size in enumerate(sizes, 1):
        publisher.send(an_image(size), 0, number)
        until(lambda count=number: len(items) == count, f"image {number}")  # type: ignore[misc]
    assert [message_of(each) for each in items] == [an_image(size) for size in sizes]


def test_a_long_sample_travels_in_shared_memory(
    pair: ZenohPair,
) -> None:
    received: list[bool] = []
    arrived = threading.Event()

    def receive(sample: zenoh.Sample) -> None:
        received.append(sample.payload.as_shm() is not None)
        arrived.set()

    peer = pair.far_zenoh.session.zenoh
    there = peer.declare_subscriber("**/sensor_msgs::msg::dds_::Image_/**", receive)
    pair.far.subscribe(
        end(EndpointKind.SUBSCRIPTION), Image, lambda _: None, shared=False
    )
    publisher = pair.near.advertise(end(EndpointKind.PUBLISHER), Image)
    pair.settle()

    def is_shared() -> bool:
        arrived.clear()
        publisher.send(an_image(1 << 20), 0, len(received) + 1)
        assert arrived.wait(20)
        return received[-1]

    until(is_shared, "the pool")
    there.undeclare()


def test_a_full_pool_and_a_copy_give_the_same_bytes() -> None:
    pools = SharedPools()
    data = serialize(an_image(1 << 20))
    until(lambda: not isinstance(pools.stored(data), bytes), "the pool")
    chunks = [pools.stored(data) for _ in range(20)]
    assert any(isinstance(each, bytes) for each in chunks)  # no room: sent as it is
    assert all(copied(zenoh.ZBytes(each)) == data for each in chunks)
