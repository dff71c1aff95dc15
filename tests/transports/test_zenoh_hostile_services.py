"""Servers and clients among peers that forge, flood or never reply."""

import logging
import queue
from collections.abc import Iterator
from typing import Any

import pytest
import zenoh
from transport_pairs import LIMIT_S, ZenohPair, until

from navette.msgs import deserialize, serialize, type_hash
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.rcl_interfaces.srv import GetParameters
from navette.runtime.clock import VirtualClock
from navette.transports import (
    Endpoint,
    EndpointKind,
    EndpointQos,
    InProcessTransport,
    Reply,
    Request,
)
from navette.transports.zenoh import ZenohTransport
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.keys import data_key
from navette.transports.zenoh.log_once import LogOnce
from navette.transports.zenoh.tokens import gid_of

ADD, GET = "example_interfaces/srv/AddTwoInts", "rcl_interfaces/srv/GetParameters"
MAX_BYTES = 1000


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    pair = ZenohPair(max_message_bytes=MAX_BYTES)
    yield pair
    pair.close()


def serve(transport: Any, type_name: str) -> tuple[list[Request], Any]:
    requests: list[Request] = []
    end = Endpoint(EndpointKind.SERVICE, "/s", type_name, EndpointQos(), "n", "/", b"")
    return requests, transport.serve(end, requests.append)


def connect(transport: Any, type_name: str) -> tuple[list[Reply], Any]:
    replies: list[Reply] = []
    end = Endpoint(EndpointKind.CLIENT, "/s", type_name, EndpointQos(), "n", "/", b"")
    return replies, transport.connect(end, replies.append)


class FalseServer:
    """Replies at once to requests for another server, without a token in the graph."""

    def __init__(self, pair: ZenohPair, response: bytes, times: int) -> None:
        self._response, self._times = response, times
        self.asked = 0
        self.transport = ZenohTransport(
            7, VirtualClock(), pair.near_zenoh.session.settings
        )
        key = data_key(7, "/s", ADD, type_hash(ADD))
        self._queryable: Any = self.transport.session.zenoh.declare_queryable(
            key, zenoh.handlers.Callback(self._answer, indirect=False), complete=True
        )

    def _answer(self, query: zenoh.Query) -> None:
        assert query.attachment is not None
        with query:
            for _ in range(self._times):
                query.reply(query.key_expr, self._response, attachment=query.attachment)
        self.asked += 1


@pytest.mark.parametrize(
    ("response", "times"),
    [(b"\x00\x01\x00\x00", 1), (serialize(AddTwoInts.Response(sum=666)), 500)],
    ids=["malformed", "forged"],
)
def test_a_server_outside_the_graph_does_not_preempt_the_real_one(
    pair: ZenohPair, response: bytes, times: int
) -> None:
    requests, server = serve(pair.near, ADD)
    replies, client = connect(pair.far, ADD)
    pair.settle()
    false = FalseServer(pair, response, times)
    sent = 0

    def both_were_called() -> bool:
        """Make one call; the link of the false server may take a while."""
        nonlocal sent
        had_a_link = false.asked > 0
        sent += 1
        client.request(AddTwoInts.Request(a=sent), 0, sent)
        until(lambda: len(requests) == sent, "the request")
        pair.settle()
        assert len(replies) == sent - 1
        server.reply(requests[-1].id, AddTwoInts.Response(sum=sent))
        until(lambda: len(replies) == sent, "the reply")
        return had_a_link

    until(both_were_called, "the false server's link")
    pair.settle()
    assert [(r.sequence, r.message.sum) for r in replies] == [
        (each, each) for each in range(1, sent + 1)
    ]
    false.transport.close()


def test_waiting_requests_are_limited(pair: ZenohPair) -> None:
    requests, server = serve(pair.near, GET)
    replies, client = connect(pair.far, GET)
    pair.settle()
    long = GetParameters.Request(names=["x" * 800])
    for sequence in (1, 2, 3):
        client.request(long, 0, sequence)
    until(lambda: len(replies) == 1, "the refusal")
    assert replies[0].failure == "2 requests with 1626 bytes wait already"
    assert [request.id.sequence for request in requests] == [1, 2]
    server.fail(requests[0].id, "no")
    client.request(long, 0, 4)
    until(lambda: len(requests) == 3, "the request that fits again")


def send_request(
    pair: ZenohPair, like: Request, *, a: int, source_ns: int
) -> queue.Queue[zenoh.Reply]:
    """Send a request with a client's gid and sequence number."""
    replies: queue.Queue[zenoh.Reply] = queue.Queue()
    pair.far_zenoh.session.zenoh.get(
        data_key(7, "/s", ADD, type_hash(ADD)),
        zenoh.handlers.Callback(replies.put, indirect=False),
        payload=serialize(AddTwoInts.Request(a=a)),
        attachment=Attachment(like.id.sequence, source_ns, like.id.client_gid).encode(),
    )
    return replies


def sum_of(replies: queue.Queue[zenoh.Reply]) -> int:
    answer = replies.get(timeout=LIMIT_S)
    assert answer.ok is not None
    return deserialize(answer.ok.payload.to_bytes(), AddTwoInts.Response).sum


@pytest.mark.parametrize("first", ["client", "forged"])
def test_a_forged_request_does_not_block_the_real_one(
    pair: ZenohPair, first: str
) -> None:
    requests, server = serve(pair.near, ADD)
    replies, client = connect(pair.far, ADD)
    pair.settle()
    client.request(AddTwoInts.Request(a=1), 0, 1)
    until(lambda: len(requests) == 1, "the request before")
    guess = requests[0]._replace(id=requests[0].id._replace(sequence=2))
    if first == "client":
        client.request(AddTwoInts.Request(a=10), 5, 2)
        until(lambda: len(requests) == 2, "the real request")
    forged = send_request(pair, guess, a=666, source_ns=6)
    if first == "forged":
        until(lambda: len(requests) == 2, "the forged request")
        client.request(AddTwoInts.Request(a=10), 5, 2)
    until(lambda: len(requests) == 3, "both requests")
    for request in reversed(requests):
        server.reply(request.id, AddTwoInts.Response(sum=request.message.a))
    until(lambda: len(replies) == 2, "the replies")
    assert {r.sequence: r.message.sum for r in replies} == {1: 1, 2: 10}
    assert sum_of(forged) == 666
    assert len(server.waiting) == 0


def test_a_duplicate_request_is_served_once_and_both_queries_answered(
    pair: ZenohPair,
) -> None:
    requests, server = serve(pair.near, ADD)
    replies, client = connect(pair.far, ADD)
    pair.settle()
    client.request(AddTwoInts.Request(a=1), 5, 1)
    until(lambda: len(requests) == 1, "the request")
    twin = send_request(pair, requests[0], a=1, source_ns=5)
    until(lambda: len(server.waiting) == 2, "the duplicate")
    server.reply(requests[0].id, AddTwoInts.Response(sum=1))
    until(lambda: len(replies) == 1, "the reply")
    assert (replies[0].message.sum, sum_of(twin), len(requests)) == (1, 1, 1)


def test_a_reply_to_a_forged_gid_does_not_reach_the_local_client() -> None:
    transport = InProcessTransport()
    requests, server = serve(transport, ADD)
    end = Endpoint(EndpointKind.CLIENT, "/s", ADD, EndpointQos(), "n", "/", b"its")
    replies: list[Reply] = []
    client = transport.connect(end, replies.append)
    client.request(AddTwoInts.Request(a=1), 0, 1)
    own = requests[0].id
    server.reply(own._replace(ticket=1), AddTwoInts.Response(sum=666))
    server.fail(own._replace(ticket=1), "no")
    assert replies == []
    server.reply(own, AddTwoInts.Response(sum=1))
    assert [reply.message.sum for reply in replies] == [1]


def test_a_request_to_another_service_is_refused(pair: ZenohPair) -> None:
    """Zenoh delivers such queries when the ends of a link disagree on key numbers."""
    requests, _ = serve(pair.near, ADD)
    other = Endpoint(EndpointKind.CLIENT, "/other", ADD, EndpointQos(), "n", "/", b"")
    token, _ = pair.far_zenoh._tokens.take(other)
    keep = pair.far_zenoh._tokens.declare(token)
    pair.settle()
    keep.undeclare()  # the link is lost and renewed, its tokens are not yet
    pair.settle()
    (answer,) = pair.far_zenoh.session.zenoh.get(
        data_key(7, "/s", ADD, type_hash(ADD)),
        payload=serialize(AddTwoInts.Request(a=2)),
        attachment=Attachment(1, 0, gid_of(token.key())).encode(),
    )
    assert answer.err is not None
    assert answer.err.payload.to_string().startswith("sent to /other")
    assert requests == []


def test_warnings_about_one_topic_are_limited(
    caplog: pytest.LogCaptureFixture,
) -> None:
    log_once = LogOnce()
    with caplog.at_level(logging.WARNING):
        for number in range(2000):
            log_once.warning(("sample", "/flooded", str(number)), "bad")
            log_once.warning(("sample", "/flooded", "the same"), "bad")
        log_once.warning(("sample", "/other", "somebody"), "bad elsewhere")
    logged = [record.getMessage() for record in caplog.records]
    assert logged[:4] == ["bad"] * 4
    assert logged[4].startswith("bad (further warnings")
    assert logged[5:] == ["bad elsewhere"]
