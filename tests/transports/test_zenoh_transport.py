"""Remote peers that send invalid data, appear, disappear, or use another type."""

import json
import logging
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from transport_pairs import LIMIT_S, ZenohPair, message_of, until

from free_ports import free_endpoint
from navette import Context, Node
from navette.errors import InvalidValueError, NetworkError
from navette.msgs import serialize, type_hash
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import Float64, String
from navette.runtime import Executor, VirtualClock
from navette.transports import (
    Encoded,
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    NodeInfo,
    Reply,
    Request,
    TransportObserver,
)
from navette.transports.zenoh import Settings, ZenohTransport
from navette.transports.zenoh import publisher as publisher_module
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.config import peer_config, router_config
from navette.transports.zenoh.graph import MAX_TOKENS_OF_A_SESSION
from navette.transports.zenoh.keys import data_key
from navette.transports.zenoh.settings import DEFAULT_ROUTER
from navette.transports.zenoh.tokens import gid_of

KEY = data_key(7, "/t", "std_msgs/msg/String", type_hash("std_msgs/msg/String"))
MAX_BYTES = 1000


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    pair = ZenohPair(max_message_bytes=MAX_BYTES)
    yield pair
    pair.close()


def endpoint(
    kind: EndpointKind,
    *,
    node: str = "n",
    topic: str = "/t",
    type_name: str = "std_msgs/msg/String",
    qos: EndpointQos | None = None,
) -> Endpoint:
    return Endpoint(kind, topic, type_name, qos or EndpointQos(), node, "/", b"")


def subscribe(transport: ZenohTransport, **of: Any) -> tuple[list[Item], Any]:
    items: list[Item] = []
    end = endpoint(EndpointKind.SUBSCRIPTION, **of)
    return items, transport.subscribe(end, String, items.append, shared=False)


def advertise(transport: ZenohTransport, **of: Any) -> Any:
    return transport.advertise(endpoint(EndpointKind.PUBLISHER, **of), String)


def texts(items: list[Item]) -> list[str]:
    return [message_of(item).data for item in items]


class Notes(TransportObserver):
    """Records notifications."""

    def __init__(self) -> None:
        self.events: list[tuple[str, str, str]] = []

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self.events.append(("matched", publisher.node_name, subscription.node_name))

    def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self.events.append(("unmatched", publisher.node_name, subscription.node_name))

    def incompatible_type(self, local: Endpoint, remote: Endpoint) -> None:
        self.events.append(("other type", local.node_name, remote.node_name))


def test_a_gap_in_the_sequence_numbers_is_reported(pair: ZenohPair) -> None:
    lost: list[tuple[str, int]] = []

    class Counting(TransportObserver):
        def message_lost(self, subscription: Endpoint, count: int) -> None:
            lost.append((subscription.node_name, count))

    pair.near.observe(Counting())
    subscribe(pair.near_zenoh, node="ear")
    pair.settle()
    hello = serialize(String(data="hello"))
    for sequence, who in ((1, 1), (2, 1), (5, 1), (1, 2), (3, 1), (6, 1), (3, 2)):
        send_raw(pair, hello, good(sequence, bytes([who] * 16)))
    pair.settle()
    assert lost == [("ear", 2), ("ear", 1)]


def test_nodes_and_endpoints_follow_their_tokens(pair: ZenohPair) -> None:
    notes = Notes()
    pair.near.observe(notes)
    node = NodeInfo("talker", "/ns", "/enclave")
    pair.far.announce(node)
    publisher = advertise(pair.far_zenoh, node="talker")
    _, port = subscribe(pair.near_zenoh, node="ear")
    pair.settle()
    assert node in pair.near.remote_nodes()
    (seen,) = pair.near.endpoints()
    assert (seen.kind, seen.topic, seen.node_name) == (
        EndpointKind.PUBLISHER,
        "/t",
        "talker",
    )
    assert seen.type_hash == type_hash("std_msgs/msg/String")
    assert (port.matched_count, publisher.matched_count) == (1, 1)
    publisher.close()
    pair.far.withdraw(node)
    pair.settle()
    assert pair.near.endpoints() == []
    assert node not in pair.near.remote_nodes()
    assert notes.events == [
        ("matched", "talker", "ear"),
        ("unmatched", "talker", "ear"),
    ]


def test_a_closed_session_removes_its_nodes_and_endpoints(pair: ZenohPair) -> None:
    notes = Notes()
    pair.near.observe(notes)
    pair.far.announce(NodeInfo("talker", "/"))
    advertise(pair.far_zenoh, node="talker")
    _, port = subscribe(pair.near_zenoh, node="ear")
    pair.settle()
    pair.far_zenoh.session.close()
    until(lambda: not pair.near.endpoints() and not pair.near.remote_nodes())
    assert port.matched_count == 0
    assert notes.events[-1] == ("unmatched", "talker", "ear")


def test_a_burst_on_one_machine_is_delivered(pair: ZenohPair) -> None:
    items, _ = subscribe(pair.near_zenoh, qos=EndpointQos(depth=5000))
    publisher = advertise(pair.far_zenoh, qos=EndpointQos(depth=5000))
    pair.settle()
    message = String(data="x" * 500)
    for number in range(1, 5001):
        publisher.send(message, 0, number)
    until(lambda: len(items) == 5000, "all samples")
    assert [item[3] for item in items] == list(range(1, 5001))


def test_gids_are_equal_at_both_ends(pair: ZenohPair) -> None:
    made = endpoint(EndpointKind.PUBLISHER)
    gid = pair.far.gid_for(made)
    assert gid is not None
    pair.far.advertise(
        Endpoint(made.kind, "/t", made.type_name, made.qos, "n", "/", gid), String
    )
    pair.settle()
    assert [e.gid for e in pair.near.endpoints()] == [gid]


def test_endpoints_with_another_type_or_hash_do_not_match(
    pair: ZenohPair,
) -> None:
    notes = Notes()
    pair.near.observe(notes)
    items, port = subscribe(pair.near_zenoh, node="ear")
    far = pair.far_zenoh
    wrong = endpoint(
        EndpointKind.PUBLISHER, node="wrong", type_name="std_msgs/msg/Float64"
    )
    far.advertise(wrong, Float64).send(Float64(data=1.0), 0, 1)
    older = endpoint(EndpointKind.PUBLISHER, node="older")
    token, _ = far._tokens.take(older)
    other = token.key().replace("RIHS01_df", "RIHS01_00")
    keep = far.session.zenoh.liveliness().declare_token(other)
    pair.settle()
    # In any order: the tokens may arrive with the direct link.
    until(lambda: len(notes.events) >= 2, "both tokens")
    others = [("other type", "ear", "older"), ("other type", "ear", "wrong")]
    assert sorted(notes.events) == others
    assert (items, port.matched_count) == ([], 0)
    assert keep


def test_a_message_is_serialised_once_and_only_for_a_subscription(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[Any] = []

    def counted(message: Any) -> bytes:
        calls.append(message)
        return serialize(message)

    monkeypatch.setattr(publisher_module, "serialize", counted)
    publisher = advertise(pair.near_zenoh)
    publisher.send(String(data="unsent"), 0, 1)
    assert calls == []
    first, _ = subscribe(pair.far_zenoh)
    second, _ = subscribe(pair.far_zenoh)
    pair.settle()
    publisher.send(String(data="received"), 0, 2)
    pair.settle()
    assert (texts(first), texts(second), len(calls)) == (["received"], ["received"], 1)


def test_raw_bytes_are_not_decoded(pair: ZenohPair) -> None:
    items, _ = subscribe(pair.far_zenoh)
    publisher = advertise(pair.near_zenoh)
    pair.settle()
    publisher.send(String(data="x"), 0, 1)
    pair.settle()
    ((message, *_),) = items
    assert isinstance(message, Encoded)
    assert message.data == serialize(String(data="x"))


def send_raw(
    pair: ZenohPair, payload: bytes, attachment: bytes | None, key: str = KEY
) -> None:
    pair.far_zenoh.session.zenoh.put(key, payload, attachment=attachment)


def good(sequence: int, gid: bytes = bytes(16)) -> bytes:
    return Attachment(sequence, 0, gid).encode()


def test_malformed_samples_are_dropped_and_logged_once(
    pair: ZenohPair, caplog: pytest.LogCaptureFixture
) -> None:
    items, _ = subscribe(pair.near_zenoh)
    publisher = advertise(pair.far_zenoh)
    pair.settle()
    hello = serialize(String(data="hello"))
    with caplog.at_level(logging.WARNING):
        for _ in range(3):
            send_raw(pair, hello, None)
            send_raw(pair, hello, b"short")
            send_raw(pair, b"", good(1))
            send_raw(pair, b"\x07\x07\x00\x00" + hello[4:], good(1))
            send_raw(pair, bytes(MAX_BYTES + 1), good(1))
        publisher.send(String(data="fine"), 0, 1)
        pair.settle()
    assert texts(items) == ["fine"]
    warnings = [r.getMessage() for r in caplog.records]
    assert len([w for w in warnings if "message ignored" in w]) == 1


def test_samples_of_a_publisher_of_another_topic_are_dropped(
    pair: ZenohPair, caplog: pytest.LogCaptureFixture
) -> None:
    """Zenoh delivers such samples when the ends of a link disagree on key numbers."""
    items, _ = subscribe(pair.near_zenoh)
    stray = endpoint(EndpointKind.PUBLISHER, node="stray", topic="/elsewhere")
    token, _ = pair.far_zenoh._tokens.take(stray)
    keep = pair.far_zenoh._tokens.declare(token)
    pair.settle()
    keep.undeclare()  # the link is lost and renewed, its tokens are not yet
    pair.settle()
    attachment = Attachment(1, 0, gid_of(token.key())).encode()
    with caplog.at_level(logging.WARNING):
        send_raw(pair, serialize(String(data="stop")), attachment)
        send_raw(pair, serialize(String(data="of an unknown publisher")), good(1))
        pair.settle()
    assert texts(items) == ["of an unknown publisher"]
    (logged,) = (r.getMessage() for r in caplog.records if "ignored" in r.getMessage())
    assert "sent on /elsewhere" in logged


def test_a_payload_of_another_type_is_detected_when_it_is_taken(
    pair: ZenohPair, caplog: pytest.LogCaptureFixture
) -> None:
    items, _ = subscribe(pair.near_zenoh)
    pair.settle()
    for sequence in (1, 2):
        send_raw(pair, b"\x00\x01\x00\x00" + bytes([255] * 40), good(sequence))
    pair.settle()
    with caplog.at_level(logging.WARNING):
        assert [message_of(item) for item in items] == [None, None]
    assert len([r for r in caplog.records if "message ignored" in r.getMessage()]) == 1


def test_duplicate_and_late_samples_are_dropped(pair: ZenohPair) -> None:
    items, _ = subscribe(pair.near_zenoh)
    pair.settle()
    one, other = bytes(16), bytes([1] * 16)
    for gid, sequence in [(one, 1), (one, 2), (one, 2), (one, 1), (other, 1), (one, 5)]:
        send_raw(pair, serialize(String(data=f"{sequence}")), good(sequence, gid))
    pair.settle()
    assert texts(items) == ["1", "2", "1", "5"]


def test_samples_of_a_publisher_with_incompatible_qos_are_dropped(
    pair: ZenohPair,
) -> None:
    latched = EndpointQos.latched()
    items, port = subscribe(pair.near_zenoh, qos=latched)
    advertise(pair.far_zenoh)
    pair.settle()
    (seen,) = pair.near.endpoints()
    send_raw(pair, serialize(String(data="x")), good(1, seen.gid))
    pair.settle()
    assert (items, port.matched_count) == ([], 0)


def test_hostile_tokens_are_ignored_and_logged_once(
    pair: ZenohPair, caplog: pytest.LogCaptureFixture
) -> None:
    liveliness = pair.far_zenoh.session.zenoh.liveliness()
    hostile = ["@ros2_lv/7/x", "@ros2_lv/7/a/b/c/MP/d/e/f/g/h/i/j", "@ros2_lv/7/a/%%"]
    with caplog.at_level(logging.WARNING):
        keep = [liveliness.declare_token(key) for key in hostile]
        keep.append(liveliness.declare_token("@ros2_lv/7/" + "a" * 5000))
        pair.settle()
    assert pair.near.endpoints() == []
    assert len(caplog.records) >= 1
    assert all("token ignored" in r.getMessage() for r in caplog.records)
    assert keep


def test_a_session_cannot_fill_the_graph(pair: ZenohPair) -> None:
    graph = pair.near_zenoh.session.graph
    for number in range(MAX_TOKENS_OF_A_SESSION + 10):
        graph.on_tokens([(f"@ros2_lv/7/abc/{number}/{number}/NN/%/%/n", True)])
    assert len(graph.nodes()) == MAX_TOKENS_OF_A_SESSION


def serve(transport: ZenohTransport) -> tuple[list[Request], Any]:
    requests: list[Request] = []
    type_name = "example_interfaces/srv/AddTwoInts"
    end = endpoint(EndpointKind.SERVICE, topic="/s", type_name=type_name)
    return requests, transport.serve(end, requests.append)


def connect(transport: ZenohTransport) -> tuple[list[Reply], Any]:
    replies: list[Reply] = []
    type_name = "example_interfaces/srv/AddTwoInts"
    end = endpoint(EndpointKind.CLIENT, topic="/s", type_name=type_name)
    return replies, transport.connect(end, replies.append)


def test_a_malformed_request_is_refused_before_the_server(
    pair: ZenohPair,
) -> None:
    requests, _ = serve(pair.near_zenoh)
    pair.settle()
    name = "example_interfaces/srv/AddTwoInts"
    key = data_key(7, "/s", name, type_hash(name))
    zenoh = pair.far_zenoh.session.zenoh
    for payload, attachment in [
        (None, good(1)),
        (b"\x00\x01\x00\x00", None),
        (b"\x00\x01\x00\x00", good(1)),
        (bytes(MAX_BYTES + 1), good(1)),
    ]:
        (reply,) = zenoh.get(
            key, payload=payload, attachment=attachment, timeout=LIMIT_S
        )
        assert reply.err is not None
    assert requests == []


def test_a_closing_server_refuses_waiting_requests(pair: ZenohPair) -> None:
    requests, server = serve(pair.near_zenoh)
    replies, client = connect(pair.far_zenoh)
    pair.settle()
    client.request(AddTwoInts.Request(), 0, 4)
    until(lambda: len(requests) == 1, "the request")
    server.close()
    until(lambda: len(replies) == 1, "the failure")
    assert replies == [Reply(None, 4, "the server was closed")]


def test_domains_do_not_see_each_other(pair: ZenohPair) -> None:
    elsewhere = ZenohTransport(8, VirtualClock(), pair.near_zenoh.session.settings)
    items, port = subscribe(elsewhere)
    publisher = advertise(pair.near_zenoh)
    pair.settle()
    publisher.send(String(data="x"), 0, 1)
    pair.settle()
    assert (elsewhere.endpoints(), elsewhere.remote_nodes(), items) == ([], [], [])
    assert (port.matched_count, publisher.matched_count) == (0, 0)
    elsewhere.close()


def test_closing_twice_leaves_no_thread(pair: ZenohPair) -> None:
    before = set(threading.enumerate())
    transport = ZenohTransport(7, VirtualClock(), pair.near_zenoh.session.settings)
    transport.announce(NodeInfo("n", "/"))
    port = advertise(transport)
    transport.close()
    port.close()
    transport.close()
    # A thread of Zenoh that called Python remains as a dummy thread.
    made = set(threading.enumerate()) - before
    assert [t for t in made if not isinstance(t, threading._DummyThread)] == []


def test_a_network_that_cannot_be_joined_is_an_error() -> None:
    with pytest.raises(NetworkError, match="cannot join the network"):
        ZenohTransport(
            0, VirtualClock(), Settings(router=("nonsense/1:1",), listen=("x",))
        )


def test_the_router_may_be_on_one_of_several_machines() -> None:
    # The first address belongs to no machine (RFC 1122), the second to this one.
    settings = Settings(router=("tcp/0.0.0.1:7447", free_endpoint()))
    first = ZenohTransport(0, VirtualClock(), settings)
    second = ZenohTransport(0, VirtualClock(), settings)
    assert first.session.serves_as_router
    assert not second.session.serves_as_router
    first.close()
    until(lambda: second.session.serves_as_router, "the other one's turn")
    second.close()


def test_the_environment_is_checked() -> None:
    with pytest.raises(InvalidValueError, match=r"NAVETTE_ROUTER: 'localhost'.*tcp/"):
        Settings.from_environment({"NAVETTE_ROUTER": "localhost"})
    with pytest.raises(InvalidValueError, match="file /nowhere does not exist"):
        Settings.from_environment({"ZENOH_SESSION_CONFIG_URI": "/nowhere"})
    with pytest.raises(InvalidValueError, match="NAVETTE_MAX_MESSAGE_BYTES 'x'"):
        Settings.from_environment({"NAVETTE_MAX_MESSAGE_BYTES": "x"})
    found = Settings.from_environment({"NAVETTE_LISTEN": "tcp/[::]:0, udp/1.2.3.4:5"})
    assert found.listen == ("tcp/[::]:0", "udp/1.2.3.4:5")


def overridden(text: str) -> Settings:
    return Settings.from_environment({"ZENOH_CONFIG_OVERRIDE": text})


def test_single_values_of_zenohs_configuration_are_overridden() -> None:
    settings = overridden(
        'mode="client"; connect/endpoints=["tcp/10.0.0.1:7447"];'
        "transport/link/tx/lease=2;"
    )
    assert settings.router == ("tcp/10.0.0.1:7447",)
    assert not settings.is_local
    config = peer_config(settings)
    assert config.get_json("mode") == '"client"'
    assert config.get_json("transport/link/tx/lease") == "2"
    assert config.get_json("connect/endpoints") == '["tcp/10.0.0.1:7447"]'


def test_endpoints_by_mode_are_left_to_zenoh() -> None:
    settings = overridden('connect/endpoints={peer: ["tcp/10.0.0.1:7447"]}')
    found = json.loads(peer_config(settings).get_json("connect/endpoints"))
    assert found["peer"] == ["tcp/10.0.0.1:7447"]


def test_an_override_that_zenoh_does_not_know_is_an_error() -> None:
    with pytest.raises(InvalidValueError, match="'lease' is not key=value"):
        overridden("lease")
    with pytest.raises(InvalidValueError, match=r"OVERRIDE: leese=3 is refused"):
        peer_config(overridden("leese=3"))


def test_a_client_by_override_meets_the_others() -> None:
    router = free_endpoint()
    near = ZenohTransport(7, VirtualClock(5), Settings(router=(router,)))
    far = ZenohTransport(
        7, VirtualClock(6), overridden(f'mode="client";connect/endpoints=["{router}"]')
    )
    far.announce(NodeInfo("client", "/"))
    until(lambda: NodeInfo("client", "/") in near.remote_nodes(), "the client's node")
    items, _ = subscribe(near, node="ear")
    publisher = advertise(far)
    until(lambda: publisher.matched_count, "the subscription")
    publisher.send(String(data="by the router"), 0, 1)
    until(lambda: items, "the message")
    assert texts(items) == ["by the router"]
    far.close()
    near.close()


@pytest.mark.parametrize(
    ("variables", "wanted"),
    [
        ({}, False),
        ({"NAVETTE_ROUTER": "tls/localhost:7", "NAVETTE_LISTEN": "tcp/[::1]:0"}, False),
        ({"NAVETTE_LISTEN": "tcp/192.168.1.7:0"}, True),
        ({"NAVETTE_ROUTER": "tcp/127.0.0.1:1,tcp/robot.local:1"}, True),
    ],
)
def test_links_between_machines_have_more_keep_alives(
    variables: dict[str, str], wanted: bool
) -> None:
    settings = Settings.from_environment(variables)
    for config in (peer_config(settings), router_config(settings, DEFAULT_ROUTER)):
        number = json.loads(config.get_json("transport/link/tx/keep_alive"))
        assert number == (20 if wanted else 4)


def test_messages_of_one_context_do_not_return_over_the_network(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_ROUTER", pair.near_zenoh.session.settings.router[0])
    with Context(transport="zenoh") as context:
        node = Node("both", context=context)
        executor = Executor(context=context)
        executor.add_node(node)
        received: list[str] = []
        node.create_subscription(String, "t", lambda m: received.append(m.data), 10)
        publisher = node.create_publisher(String, "t", 10)
        remote, _ = subscribe(pair.near_zenoh)
        # (a context of domain 0, the pair of domain 7: no remote subscription)
        assert publisher.get_subscription_count() == 1
        publisher.publish(String(data="once"))
        executor.spin_once(timeout_sec=0)
        executor.spin_once(timeout_sec=0)
        assert (received, remote) == (["once"], [])


def test_gids_of_the_graph_equal_those_on_the_wire(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_ROUTER", pair.near_zenoh.session.settings.router[0])
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    with Context(transport="zenoh") as context:
        node = Node("here", context=context)
        publisher = node.create_publisher(String, "t", 10)
        gids = [publisher.endpoint.gid]
        until(lambda: [e.gid for e in pair.near.endpoints() if e.topic == "/t"] == gids)
        assert gid_of("") not in gids


def test_latched_samples_do_not_return_to_their_own_session(
    pair: ZenohPair,
) -> None:
    latched = EndpointQos.latched()
    publisher = advertise(pair.near, qos=latched)
    publisher.send(String(data="map"), 1, 1)
    here, _ = subscribe(pair.near, qos=latched)
    there, _ = subscribe(pair.far, qos=latched)
    until(lambda: bool(there), "the latched sample")
    publisher.send(String(data="newer"), 2, 2)
    until(lambda: len(there) == 2, "the next sample")
    assert texts(there) == ["map", "newer"]
    assert here == []
