"""A client's tokens may be read later than its request."""

from dataclasses import replace
from typing import Any

from transport_pairs import ZenohPair, message_of, until

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


def endpoint(kind: EndpointKind, qos: EndpointQos | None = None) -> Endpoint:
    service = kind in (EndpointKind.SERVICE, EndpointKind.CLIENT)
    name, type_name = (
        ("/start", "example_interfaces/srv/AddTwoInts")
        if service
        else ("/progress", "std_msgs/msg/String")
    )
    return Endpoint(kind, name, type_name, qos or EndpointQos(), "n", "/", b"")


class Worker:
    """Publishes its progress on a topic before it replies."""

    def __init__(self, pair: ZenohPair, qos: EndpointQos | None = None) -> None:
        self._requests: list[Request] = []
        offer = endpoint(EndpointKind.PUBLISHER, qos)
        self._progress = pair.near.advertise(offer, String)
        self._port = pair.near.serve(endpoint(EndpointKind.SERVICE), self._answer)
        pair.settle()

    def _answer(self, request: Request) -> None:
        self._progress.send(String(data="working"), 0, 1)
        self._port.reply(request.id, AddTwoInts.Response(sum=request.message.a))


class Requester:
    """Subscribes to the progress and sends a request."""

    def __init__(self, pair: ZenohPair) -> None:
        self.replies: list[Reply] = []
        self.items: list[Item] = []
        # The client comes first: the order of declarations does not matter.
        self.client = pair.far.connect(
            endpoint(EndpointKind.CLIENT), self.replies.append
        )
        self._subscription: Any = pair.far.subscribe(
            endpoint(EndpointKind.SUBSCRIPTION), String, self.items.append, shared=False
        )

    def call(self) -> None:
        self.client.request(AddTwoInts.Request(a=3), 0, 1)
        until(lambda: bool(self.replies), "the reply")


def test_messages_reach_a_requester_whose_tokens_are_unread(
    pair: ZenohPair,
) -> None:
    Worker(pair)
    with pair.near_zenoh.session.graph._lock:  # the server's graph cannot change
        requester = Requester(pair)
        requester.call()
        assert pair.near_zenoh.session.graph._endpoints == {}
    assert requester.replies[0].message.sum == 3
    until(lambda: len(requester.items) == 1, "the progress")
    assert message_of(requester.items[0]).data == "working"


def test_a_publisher_with_incompatible_qos_is_not_received(pair: ZenohPair) -> None:
    Worker(pair, BEST_EFFORT)
    requester = Requester(pair)
    pair.settle()
    requester.call()
    pair.settle()
    assert requester.items == []


def test_a_message_in_response_to_a_message_is_received(pair: ZenohPair) -> None:
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
        requester = Requester(pair)
        offer = replace(question, kind=EndpointKind.PUBLISHER)
        pair.far.advertise(offer, String).send(String(data="?"), 0, 1)
        until(lambda: len(requester.items) == 1, "the answer")


def test_after_two_seconds_only_the_graph_counts(pair: ZenohPair) -> None:
    publisher = pair.near.advertise(endpoint(EndpointKind.PUBLISHER), String)
    with pair.near_zenoh.session.graph._lock:
        requester = Requester(pair)
        publisher.send(String(data="not sent"), 10_000_000_000, 1)
    pair.settle()
    assert requester.items == []
