"""Conformance suite for services, run with every transport."""

from collections.abc import Iterator

import pytest
from transport_pairs import PAIRS, InProcessPair, Pair

from navette.errors import InvalidValueError
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.transports import (
    ClientPort,
    Endpoint,
    EndpointKind,
    EndpointQos,
    ReliabilityPolicy,
    Reply,
    Request,
    ServicePort,
    TransportObserver,
)

TYPE = "example_interfaces/srv/AddTwoInts"


class Bench:
    """Opens servers at one end and clients at the other, and records what arrives."""

    def __init__(self, pair: Pair) -> None:
        self.pair = pair
        self.settle = pair.settle
        self._count = 0

    def _endpoint(
        self, kind: EndpointKind, name: str, type_name: str, qos: EndpointQos | None
    ) -> Endpoint:
        self._count += 1
        gid = self._count.to_bytes(16, "big")
        node = f"n{self._count}"
        return Endpoint(kind, name, type_name, qos or EndpointQos(), node, "/", gid)

    def server(
        self, name: str = "/s", type_name: str = TYPE, qos: EndpointQos | None = None
    ) -> tuple[list[Request], ServicePort]:
        requests: list[Request] = []
        endpoint = self._endpoint(EndpointKind.SERVICE, name, type_name, qos)
        port = self.pair.near.serve(endpoint, requests.append)
        self.settle()
        return requests, port

    def client(
        self, name: str = "/s", type_name: str = TYPE, qos: EndpointQos | None = None
    ) -> tuple[list[Reply], ClientPort]:
        replies: list[Reply] = []
        endpoint = self._endpoint(EndpointKind.CLIENT, name, type_name, qos)
        port = self.pair.far.connect(endpoint, replies.append)
        self.settle()
        return replies, port


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


def test_a_reply_reaches_the_client_of_the_request(bench: Bench) -> None:
    requests, server = bench.server()
    first, port_1 = bench.client()
    second, port_2 = bench.client()
    port_1.request(AddTwoInts.Request(a=1), 100, 7)
    port_2.request(AddTwoInts.Request(a=2), 200, 7)
    bench.settle()
    assert [(r.message.a, r.source_ns) for r in requests] == [(1, 100), (2, 200)]
    for request in reversed(requests):
        server.reply(request.id, AddTwoInts.Response(sum=request.message.a))
    bench.settle()
    assert [(r.message.sum, r.sequence) for r in first] == [(1, 7)]
    assert [(r.message.sum, r.sequence) for r in second] == [(2, 7)]


def test_later_changes_of_a_message_have_no_effect(bench: Bench) -> None:
    requests, server = bench.server()
    replies, client = bench.client()
    asked = AddTwoInts.Request(a=1)
    client.request(asked, 0, 1)
    asked.a = 99
    bench.settle()
    answer = AddTwoInts.Response(sum=requests[0].message.a)
    server.reply(requests[0].id, answer)
    answer.sum = 99
    bench.settle()
    assert replies[0].message.sum == 1


def test_a_failure_is_reported(bench: Bench) -> None:
    requests, server = bench.server()
    replies, client = bench.client()
    client.request(AddTwoInts.Request(), 0, 3)
    bench.settle()
    server.fail(requests[0].id, "ValueError: no")
    bench.settle()
    assert replies == [Reply(None, 3, "ValueError: no")]


def test_servers_are_counted(bench: Bench) -> None:
    _, client = bench.client()
    assert client.server_count == 0
    client.request(AddTwoInts.Request(), 0, 1)  # no server yet
    requests, server = bench.server()
    bench.server("/other")
    bench.settle()
    assert client.server_count == 1
    server.close()
    server.close()
    bench.settle()
    assert (client.server_count, requests) == (0, [])


def test_a_reply_to_a_closed_client_is_dropped(bench: Bench) -> None:
    requests, server = bench.server()
    replies, client = bench.client()
    client.request(AddTwoInts.Request(), 0, 1)
    client.close()
    bench.settle()
    server.reply(requests[0].id, AddTwoInts.Response())
    bench.settle()
    server.fail(requests[0].id, "too late")
    bench.settle()
    assert replies == []


def test_another_type_is_refused_and_leaves_nothing(local_bench: Bench) -> None:
    local_bench.server()
    with pytest.raises(InvalidValueError, match=r"AddTwoInts \(/n1\); node /n2 .*Se"):
        local_bench.client(type_name="std_srvs/srv/SetBool")
    with pytest.raises(InvalidValueError, match=r"/n3 cannot serve it as std_srvs"):
        local_bench.server(type_name="std_srvs/srv/SetBool")
    assert [e.node_name for e in local_bench.pair.service_endpoints()] == ["n1"]


def test_a_service_may_have_the_name_of_a_topic(bench: Bench) -> None:
    bench.server("/same")
    assert bench.pair.endpoints() == []
    assert [e.kind for e in bench.pair.service_endpoints()] == [EndpointKind.SERVICE]


def test_endpoints_with_incompatible_qos_do_not_match(bench: Bench) -> None:
    best_effort = EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT)
    requests, _ = bench.server()
    _, client = bench.client(qos=best_effort)
    client.request(AddTwoInts.Request(), 0, 1)
    bench.settle()
    assert (client.server_count, requests) == (0, [])


def test_changes_are_reported(local_bench: Bench) -> None:
    changes: list[int] = []

    class Observer(TransportObserver):
        def graph_changed(self) -> None:
            changes.append(len(local_bench.pair.service_endpoints()))

    local_bench.pair.observe(Observer())
    _, server = local_bench.server()
    local_bench.client()
    server.close()
    assert changes == [1, 2, 1]
