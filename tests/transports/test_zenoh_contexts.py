"""Nodes of contexts that share only the network."""

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from transport_pairs import until

from free_ports import free_endpoint
from navette import Context, DurabilityPolicy, HistoryPolicy, Node, QoSProfile
from navette.errors import InvalidValueError
from navette.msgs import serialize, type_hash
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.rcl_interfaces.msg import Log
from navette.msgs.std_msgs.msg import Float64, String
from navette.runtime import Executor
from navette.runtime.context import new_graph
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from navette.transports.zenoh import ZenohTransport, own_tokens
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.keys import data_key

LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Network:
    """Contexts with their own sessions, and executors for their nodes."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._executors: list[Executor] = []

    def node(self, name: str) -> Node:
        context = self._stack.enter_context(Context(transport="zenoh"))
        node = Node(name, context=context)
        executor = Executor(context=context)
        executor.add_node(node)
        self._executors.append(executor)
        return node

    def until(self, condition: Any, what: str) -> None:
        def look() -> bool:
            for executor in self._executors:
                for _ in range(20):
                    executor.spin_once(timeout_sec=0.0)
            return bool(condition())

        until(look, what)


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator[Network]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    with ExitStack() as stack:
        yield Network(stack)


def transport_of(node: Node) -> ZenohTransport:
    transport = node.context.graph.transports[1]
    assert isinstance(transport, ZenohTransport)
    return transport


def test_messages_of_a_late_publisher_arrive_once(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    received: list[str] = []
    here.create_subscription(String, "map", lambda m: received.append(m.data), LATCHED)
    publisher = there.create_publisher(String, "map", LATCHED)
    for text in ("a", "b"):
        publisher.publish(String(data=text))
    network.until(lambda: len(received) >= 2, "both")
    publisher.publish(String(data="c"))
    network.until(lambda: len(received) >= 3, "the third")
    assert received == ["a", "b", "c"]


def test_reliable_and_keep_all_is_complete_and_in_order(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    qos = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    received: list[float] = []
    here.create_subscription(Float64, "t", lambda m: received.append(m.data), qos)
    publisher = there.create_publisher(Float64, "t", qos)
    until(lambda: publisher.get_subscription_count() == 1, "the match")
    for number in range(1000):
        publisher.publish(Float64(data=float(number)))
    network.until(lambda: len(received) >= 1000, "everything")
    assert received == list(range(1000))


def test_a_slow_subscription_keeps_the_newest(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    received: list[str] = []
    here.create_subscription(String, "t", lambda m: received.append(m.data), 2)
    last: list[str] = []
    here.create_subscription(String, "end", lambda m: last.append(m.data), 1)
    publisher = there.create_publisher(String, "t", 10)
    end = there.create_publisher(String, "end", 1)
    until(lambda: end.get_subscription_count() == 1, "the match")
    until(lambda: publisher.get_subscription_count() == 1, "the match")
    for number in range(5):
        publisher.publish(String(data=str(number)))
    end.publish(String(data="end"))
    waiting = next(s for s in here.subscriptions if s.topic == "/end")
    until(lambda: len(waiting._queue) == 1, "the arrival of all")
    network.until(lambda: last, "the end")
    network.until(lambda: len(received) >= 2, "what was kept")
    assert received == ["3", "4"]


def test_an_invalid_payload_is_dropped(
    network: Network,
) -> None:
    here, there = network.node("here"), network.node("there")
    received: list[Any] = []
    with_info: list[Any] = []
    raw: list[Any] = []
    here.create_subscription(String, "t", received.append, 10)
    here.create_subscription(String, "t", lambda m, info: with_info.append(m.data), 10)
    here.create_subscription(String, "t", raw.append, 10, raw=True)
    publisher = there.create_publisher(String, "t", 10)
    until(lambda: publisher.get_subscription_count() == 3, "the matches")
    garbage = b"\x00\x01\x00\x00" + b"\xff" * 20
    key = data_key(0, "/t", "std_msgs/msg/String", type_hash("std_msgs/msg/String"))
    attachment = Attachment(1, 0, bytes(16)).encode()
    transport_of(there).session.zenoh.put(key, garbage, attachment=attachment)
    publisher.publish(String(data="fine"))
    network.until(lambda: received and with_info and len(raw) == 2, "the good one")
    assert ([m.data for m in received], with_info) == (["fine"], ["fine"])
    assert raw == [garbage, serialize(String(data="fine"))]  # unchanged


def test_local_and_remote_servers_are_each_called_once(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    asked: list[str] = []

    def serve(node: Node) -> None:
        def add(request: Any, response: Any) -> Any:
            asked.append(node.get_name())
            response.sum = request.a + request.b
            return response

        node.create_service(AddTwoInts, "add", add)

    serve(here)
    serve(there)
    client = here.create_client(AddTwoInts, "add")
    until(lambda: sum(p.server_count for p in client.ports) == 2, "both servers")
    future = client.call_async(AddTwoInts.Request(a=1, b=2))
    network.until(lambda: future.done() and len(asked) == 2, "both answers")
    assert (future.result().sum, sorted(asked)) == (3, ["here", "there"])


def test_an_awaited_service_may_call_back_into_the_waiting_group(
    network: Network,
) -> None:
    here, there = network.node("here"), network.node("there")
    back = there.create_client(AddTwoInts, "add")
    sums: list[int] = []

    def add(request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    async def twice(request: Any, response: Any) -> Any:
        response.sum = 2 * (await back.call_async(request)).sum
        return response

    async def ask() -> None:
        timer.cancel()
        sums.append((await client.call_async(AddTwoInts.Request(a=1, b=2))).sum)

    here.create_service(AddTwoInts, "add", add)
    there.create_service(AddTwoInts, "twice", twice)
    client = here.create_client(AddTwoInts, "twice")
    network.until(lambda: client.service_is_ready(), "twice")
    network.until(lambda: back.service_is_ready(), "add")
    timer = here.create_timer(0.001, ask)
    network.until(lambda: sums, "the answer")
    assert sums == [6]


def test_events_report_remote_endpoints(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    alive: list[int] = []
    matched: list[int] = []
    types: list[int] = []
    here.create_subscription(
        String,
        "t",
        lambda m: None,
        10,
        event_callbacks=SubscriptionEventCallbacks(
            liveliness=lambda info: alive.append(info.alive_count),
            matched=lambda info: matched.append(info.current_count),
            incompatible_type=lambda info: types.append(info.total_count),
        ),
    )
    publisher = there.create_publisher(String, "t", 10)
    network.until(lambda: alive == [1] and matched == [1], "the publisher")
    publisher.destroy()
    network.until(lambda: alive == [1, 0] and matched == [1, 0], "its end")
    other: list[int] = []
    there.create_publisher(
        Float64,
        "t",
        10,
        event_callbacks=PublisherEventCallbacks(
            incompatible_type=lambda info: other.append(info.total_count)
        ),
    )
    network.until(lambda: types == [1] and other == [1], "the other type")


def test_a_different_definition_at_the_other_end_is_a_warning(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = network.node("here"), network.node("there")
    texts: dict[str, str] = {}
    here.create_subscription(
        Log, "/rosout", lambda log: texts.update({log.name: log.msg}), LATCHED
    )
    here.create_subscription(String, "t", lambda m: None, 10)
    other = f"RIHS01_{'0' * 64}"
    monkeypatch.setattr(own_tokens, "wire_hash", lambda type_name: other)
    there.create_publisher(String, "t", 10)
    network.until(lambda: len(texts) == 2, "both warnings")
    assert texts["here"] == (
        "topic /t: the publisher of /there has a different definition of "
        f"std_msgs/msg/String ({other}); the endpoints exchange no messages"
    )
    assert "the subscription of /here has a different definition" in texts["there"]


def test_a_node_may_handle_several_types_of_a_topic(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    received: list[Any] = []
    types: list[int] = []
    events = SubscriptionEventCallbacks(incompatible_type=types.append)
    for kind, other in ((String, Float64), (Float64, String)):
        here.create_subscription(
            kind, "t", received.append, 10, event_callbacks=events, other_types=[other]
        )
    text = there.create_publisher(String, "t", 10)
    guest = network.node("guest")
    number = guest.create_publisher(Float64, "t", 10)
    ready = [text, number]
    network.until(
        lambda: all(each.get_subscription_count() == 1 for each in ready), "a match"
    )
    text.publish(String(data="a"))
    network.until(lambda: len(received) == 1, "the text")
    number.publish(Float64(data=1.0))
    network.until(lambda: len(received) == 2, "the number")
    assert received == [String(data="a"), Float64(data=1.0)]
    assert types == []


def test_destroyed_endpoints_leave_nothing_behind(network: Network) -> None:
    here, there = network.node("here"), network.node("there")
    for _ in range(3):
        guest = Node("guest", context=here.context)
        guest.create_publisher(String, "t", LATCHED)
        guest.create_subscription(String, "t", lambda m: None, 10)
        guest.create_client(AddTwoInts, "add")
        guest.destroy_node()
    here.destroy_node()
    until(lambda: there.get_node_names() == ["there"], "the end of the nodes")
    transport = transport_of(here)
    assert not transport._ports
    assert not transport._tokens.nodes()
    assert not transport._tokens._created
    assert not transport.own_gids
    assert not transport.session.graph._locals
    graph = transport_of(there).session.graph
    until(lambda: not graph._endpoints and not graph._by_name, "the end of endpoints")
    assert not graph._count_of


def test_contexts_of_one_graph_share_the_session_and_the_domain(
    network: Network,
) -> None:
    graph = new_graph()
    with Context(graph=graph, transport="zenoh"):
        with Context(graph=graph, transport="zenoh"):
            assert len(graph.transports) == 2
        third = Context(graph=graph, transport="zenoh")
        with pytest.raises(InvalidValueError, match=r"domain 9: .* domain 0"):
            third.init(args=[], domain_id=9)
    graph.close()


def test_a_graph_with_nodes_cannot_join_the_network(network: Network) -> None:
    graph = new_graph()
    with Context(graph=graph, transport="inprocess") as context:
        Node("early", context=context)
        with pytest.raises(InvalidValueError, match=r"has nodes already \(/early\)"):
            Context(graph=graph, transport="zenoh").init(args=[])
    graph.close()


def test_rmw_zenohs_configuration_files_are_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    router = free_endpoint()
    session = {
        "mode": "peer",
        "connect": {"endpoints": [router]},
        "listen": {"endpoints": ["tcp/127.0.0.1:0"]},
        "scouting": {"multicast": {"enabled": False}, "delay": 0},
    }
    file = tmp_path / "session.json5"
    file.write_text(f"// as ROS 2 has it\n{json.dumps(session)}", encoding="utf-8")
    monkeypatch.setenv("ZENOH_SESSION_CONFIG_URI", str(file))
    with ExitStack() as stack:
        network = Network(stack)
        here, there = network.node("here"), network.node("there")
        assert transport_of(here).session.serves_as_router
        assert not transport_of(there).session.serves_as_router
        assert sorted(there.get_node_names()) == ["here", "there"]
