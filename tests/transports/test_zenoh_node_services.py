"""Services directly below a node's name share a queryable."""

from pathlib import Path
from typing import Any

import zenoh
from transport_pairs import ZenohPair, until

from navette.msgs import serialize, type_hash
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.runtime.clock import VirtualClock
from navette.transports import Endpoint, EndpointKind, EndpointQos, Reply, Request
from navette.transports.zenoh import Settings, ZenohTransport
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.keys import data_key

ADD = "example_interfaces/srv/AddTwoInts"


class Server:
    """A server of the node ``/n`` that replies with its own number."""

    def __init__(self, transport: ZenohTransport, name: str, number: int) -> None:
        end = Endpoint(EndpointKind.SERVICE, name, ADD, EndpointQos(), "n", "/", b"")
        self.number = number
        self.port: Any = transport.serve(end, self._answer)

    def _answer(self, request: Request) -> None:
        self.port.reply(request.id, AddTwoInts.Response(sum=self.number))


def call(pair: ZenohPair, name: str) -> Reply:
    """Send a request from the far end; return the reply."""
    replies: list[Reply] = []
    end = Endpoint(EndpointKind.CLIENT, name, ADD, EndpointQos(), "m", "/", b"")
    client = pair.far.connect(end, replies.append)
    pair.settle()
    client.request(AddTwoInts.Request(), 0, 1)
    until(lambda: bool(replies), "a reply")
    client.close()
    return replies[0]


def sum_of(reply: Reply) -> Any:
    assert reply.message is not None, reply
    return reply.message.sum


def test_each_service_receives_its_own_requests(pair: ZenohPair) -> None:
    near = pair.near_zenoh
    a, b = Server(near, "/n/a", 1), Server(near, "/n/b", 2)
    assert [*near._queryables._shared] == ["7/n"]
    assert sum_of(call(pair, "/n/a")) == 1
    assert sum_of(call(pair, "/n/b")) == 2
    a.port.close()
    assert sum_of(call(pair, "/n/b")) == 2
    b.port.close()
    assert not near._queryables._shared


def test_a_remote_service_below_the_same_node_name_is_called(
    pair: ZenohPair,
) -> None:
    Server(pair.near_zenoh, "/n/a", 1)
    third = ZenohTransport(7, VirtualClock(), pair.near_zenoh.session.settings)
    end = Endpoint(EndpointKind.SERVICE, "/n/c", ADD, EndpointQos(), "o", "/", b"")
    port: Any = None

    def answer(request: Request) -> None:
        port.reply(request.id, AddTwoInts.Response(sum=3))

    port = third.serve(end, answer)
    until(lambda: len(pair.far.service_endpoints()) == 2, "both servers' tokens")
    assert sum_of(call(pair, "/n/c")) == 3
    third.close()


def test_queries_without_a_server_get_no_reply(pair: ZenohPair) -> None:
    server = Server(pair.near_zenoh, "/n/a", 1)
    pair.settle()
    gid = bytes(16)
    for name, count in ("/n/a", 1), ("/n/none", 0), ("/n/a/b", 0):
        answers = pair.far_zenoh.session.zenoh.get(
            data_key(7, name, ADD, type_hash(ADD)),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            payload=serialize(AddTwoInts.Request()),
            attachment=Attachment(1, 0, gid).encode(),
        )
        assert len(list(answers)) == count
    # A query for all services of the node gets no reply either.
    assert not list(pair.far_zenoh.session.zenoh.get("7/n/**"))
    server.port.close()


def test_a_second_server_of_the_same_name_is_called_too(pair: ZenohPair) -> None:
    first, second = (Server(pair.near_zenoh, "/n/a", number) for number in (1, 2))
    assert sum_of(call(pair, "/n/a")) in (1, 2)
    first.port.close()
    assert sum_of(call(pair, "/n/a")) == 2
    second.port.close()


def test_with_access_rules_each_service_has_its_own_queryable() -> None:
    assert not Settings().has_rules
    assert Settings(security=Path("keys")).has_rules
    assert Settings(session_file=Path("session.json5")).has_rules
