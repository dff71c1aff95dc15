"""Who asks is heard of by its tokens, which may be read later than what it asks."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from transport_benches import ZenohPair, message_of, until

from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import String
from navette.transports import (
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    ReliabilityPolicy,
    Reply,
    Request,
)

BEST_EFFORT = EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    pair = ZenohPair()
    yield pair
    pair.close()


def endpoint(kind: EndpointKind, qos: EndpointQos | None = None) -> Endpoint:
    service = kind in (EndpointKind.SERVICE, EndpointKind.CLIENT)
    name, type_name = (
        ("/start", "example_interfaces/srv/AddTwoInts")
        if service
        else ("/progress", "std_msgs/msg/String")
    )
    return Endpoint(kind, name, type_name, qos or EndpointQos(), "n", "/", b"")


class Worker:
    """Tells of its progress on a topic before it answers."""

    def __init__(self, pair: ZenohPair, qos: EndpointQos | None = None) -> None:
        self._requests: list[Request] = []
        offer = endpoint(EndpointKind.PUBLISHER, qos)
        self._progress = pair.near.advertise(offer, String)
        self._port = pair.near.serve(endpoint(EndpointKind.SERVICE), self._answer)
        pair.settle()

    def _answer(self, request: Request) -> None:
        self._progress.send(String(data="working"), 0, 1)
        self._port.reply(request.id, AddTwoInts.Response(sum=request.message.a))


class Asker:
    """Listens to the progress, and asks."""

    def __init__(self, pair: ZenohPair) -> None:
        self.replies: list[Reply] = []
        self.items: list[Item] = []
        # The client comes first: no order of declarations is relied upon.
        self.client = pair.far.connect(
            endpoint(EndpointKind.CLIENT), self.replies.append
        )
        self._ears: Any = pair.far.subscribe(
            endpoint(EndpointKind.SUBSCRIPTION), String, self.items.append, shared=False
        )

    def ask(self) -> None:
        self.client.request(AddTwoInts.Request(a=3), 0, 1)
        until(lambda: bool(self.replies), "the reply")


def test_who_asks_hears_what_follows_though_its_tokens_are_still_unread(
    pair: ZenohPair,
) -> None:
    Worker(pair)
    with pair.near_zenoh.session.graph._lock:  # nothing new is known at the server
        asker = Asker(pair)
        asker.ask()
        assert pair.near_zenoh.session.graph._endpoints == {}
    assert asker.replies[0].message.sum == 3
    until(lambda: len(asker.items) == 1, "the progress")
    assert message_of(asker.items[0]).data == "working"


def test_an_offer_that_falls_short_is_still_not_heard(pair: ZenohPair) -> None:
    Worker(pair, BEST_EFFORT)
    asker = Asker(pair)
    pair.settle()
    asker.ask()
    pair.settle()
    assert asker.items == []


def test_an_answer_by_topic_is_heard_too(pair: ZenohPair) -> None:
    answering = pair.near.advertise(endpoint(EndpointKind.PUBLISHER), String)
    question = Endpoint(
        EndpointKind.SUBSCRIPTION,
        "/question",
        "std_msgs/msg/String",
        EndpointQos(),
        "n",
        "/",
        b"",
    )
    pair.near.subscribe(
        question,
        String,
        lambda _: answering.send(String(data="answer"), 0, 1),
        shared=False,
    )
    pair.settle()
    with pair.near_zenoh.session.graph._lock:
        asker = Asker(pair)
        offer = replace(question, kind=EndpointKind.PUBLISHER)
        pair.far.advertise(offer, String).send(String(data="?"), 0, 1)
        until(lambda: len(asker.items) == 1, "the answer")


def test_who_has_heard_nothing_for_long_asks_nobody(pair: ZenohPair) -> None:
    publisher = pair.near.advertise(endpoint(EndpointKind.PUBLISHER), String)
    with pair.near_zenoh.session.graph._lock:
        asker = Asker(pair)
        publisher.send(String(data="unheard"), 10_000_000_000, 1)
    pair.settle()
    assert asker.items == []
