"""Peers of other distributions: tokens, keys and attachments as they write them."""

import threading
from typing import Any

import zenoh
from transport_pairs import LIMIT_S, ZenohPair, message_of, until

from navette.msgs import deserialize, serialize, type_hash
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.sensor_msgs.msg import Image
from navette.transports import Endpoint, EndpointKind, EndpointQos, Item, Reply
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.keys import data_key
from navette.transports.zenoh.tokens import gid_of

IMAGE, ADD = "sensor_msgs/msg/Image", "example_interfaces/srv/AddTwoInts"
BACKENDS = "/backends:cpu:"  # Lyrical's, after types with an unbounded uint8[]


class Peer:
    """One node ``cam`` on a session of its own, without Navette's transport."""

    def __init__(self, pair: ZenohPair) -> None:
        self.zenoh = pair.far_zenoh.session.zenoh
        # Navette ignores tokens of its own session only: this is another.
        self._head = f"@ros2_lv/7/{'ab' * 16}/0"
        self._kept = [self._declare(f"{self._head}/0/NN/%/%/cam")]

    def declare(
        self, kind: str, name: str, dds_type: str, of: str, more: str = ""
    ) -> bytes:
        """Declare an endpoint; return its gid."""
        key = (
            f"{self._head}/{len(self._kept)}/{kind}/%/%/cam/{name}/{dds_type}/"
            f"{type_hash(of)}/::,5:,:,:,,{more}"
        )
        self._kept.append(self._declare(key))
        return gid_of(key)

    def _declare(self, key: str) -> Any:
        return self.zenoh.liveliness().declare_token(key)


def an_image() -> Image:
    return Image(height=2, width=3, encoding="mono8", step=3, data=bytes(range(6)))


def end(kind: EndpointKind, topic: str, type_name: str) -> Endpoint:
    return Endpoint(kind, topic, type_name, EndpointQos(), "n", "/", b"")


def test_images_go_both_ways_with_a_peer_that_announces_backends(
    pair: ZenohPair,
) -> None:
    peer = Peer(pair)
    dds = "sensor_msgs::msg::dds_::Image_"
    gid = peer.declare("MP", "%from", dds, IMAGE, BACKENDS)
    peer.declare("MS", "%to", dds, IMAGE, BACKENDS)
    received: list[bytes] = []
    there = peer.zenoh.declare_subscriber(
        data_key(7, "/to", IMAGE, type_hash(IMAGE)),
        lambda sample: received.append(sample.payload.to_bytes()),
    )
    items: list[Item] = []
    here = pair.near.subscribe(
        end(EndpointKind.SUBSCRIPTION, "/from", IMAGE), Image, items.append,
        shared=False,
    )  # fmt: skip
    publisher = pair.near.advertise(end(EndpointKind.PUBLISHER, "/to", IMAGE), Image)
    pair.settle()
    assert (here.matched_count, publisher.matched_count) == (1, 1)
    listed = {each.topic: each for each in pair.near.endpoints()}
    assert listed["/from"].gid == gid

    peer.zenoh.put(
        data_key(7, "/from", IMAGE, type_hash(IMAGE)),
        serialize(an_image()),
        attachment=Attachment(1, 0, gid).encode(),
    )
    publisher.send(an_image(), 0, 1)
    until(lambda: bool(items and received), "the images")
    assert message_of(items[0]) == an_image()
    assert deserialize(received[0], Image) == an_image()
    there.undeclare()


def test_a_reply_with_the_servers_own_gid_is_accepted(pair: ZenohPair) -> None:
    """As servers on Pico-ROS send it; the query leads it to the right client."""
    peer = Peer(pair)
    key = data_key(7, "/add", ADD, type_hash(ADD))
    asked = threading.Event()

    def answer(query: zenoh.Query) -> None:
        assert query.payload is not None
        assert query.attachment is not None
        request = deserialize(query.payload.to_bytes(), AddTwoInts.Request)
        sequence = int.from_bytes(query.attachment.to_bytes()[:8], "little")
        query.reply(
            query.key_expr,
            serialize(AddTwoInts.Response(sum=request.a + request.b)),
            attachment=Attachment(sequence, 0, b"\x07" * 16).encode(),
        )
        asked.set()

    there = peer.zenoh.declare_queryable(key, answer, complete=True)
    dds = "example_interfaces::srv::dds_::AddTwoInts_"
    peer.declare("SS", "%add", dds, ADD)
    replies: list[Reply] = []
    client = pair.near.connect(end(EndpointKind.CLIENT, "/add", ADD), replies.append)
    pair.settle()
    client.request(AddTwoInts.Request(a=2, b=3), 0, 1)
    assert asked.wait(LIMIT_S)
    until(lambda: bool(replies), "the reply")
    assert replies[0].message == AddTwoInts.Response(sum=5)
    there.undeclare()
