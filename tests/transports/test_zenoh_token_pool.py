"""New endpoints reuse the liveliness tokens of closed ones of the same kind."""

from collections.abc import Iterator
from typing import Any

import pytest
from transport_pairs import ZenohPair, message_of, until

from free_ports import free_endpoint
from navette import Context, Node
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import String
from navette.runtime import Executor
from navette.transports import (
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    ReliabilityPolicy,
    TransportObserver,
)

BEST_EFFORT = EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT)

SUBSCRIPTION = Endpoint(
    EndpointKind.SUBSCRIPTION,
    "/t",
    "std_msgs/msg/String",
    EndpointQos(),
    "receiver",
    "/",
    b"",
)


def publisher(
    pair: ZenohPair, topic: str = "/t", qos: EndpointQos | None = None
) -> tuple[bytes, Any]:
    """Open a publisher; return its gid and port."""
    name = "std_msgs/msg/String"
    kind = EndpointKind.PUBLISHER
    end = Endpoint(kind, topic, name, qos or EndpointQos(), "n", "/", b"")
    gid = pair.far.gid_for(end)
    assert gid is not None
    return gid, pair.far.advertise(
        Endpoint(kind, topic, name, end.qos, "n", "/", gid), String
    )


def test_tokens_are_reused_for_the_same_topic_and_qos(
    pair: ZenohPair,
) -> None:
    first, port = publisher(pair)
    second, _ = publisher(pair)
    port.close()
    elsewhere, _ = publisher(pair, "/u")
    other, _ = publisher(pair, qos=BEST_EFFORT)
    again, _ = publisher(pair)
    more, _ = publisher(pair)
    assert again == first
    assert len({first, second, elsewhere, other, more}) == 5


def test_sequence_numbers_continue(pair: ZenohPair) -> None:
    items: list[Item] = []
    pair.near.subscribe(SUBSCRIPTION, String, items.append, shared=False)
    for number, text in enumerate("abc"):
        _, port = publisher(pair)
        assert port.initial_sequence == number
        pair.settle()
        port.send(String(data=text), 0, number + 1)
        pair.settle()
        port.close()
        pair.settle()
        assert pair.near.endpoints() == []
    assert [message_of(item).data for item in items] == ["a", "b", "c"]


def test_a_new_subscription_reports_no_loss_of_earlier_samples(pair: ZenohPair) -> None:
    _, port = publisher(pair)
    for number in (1, 2, 3):
        port.send(String(data="earlier"), 0, number)
    port.close()
    lost: list[int] = []

    class Notes(TransportObserver):
        def message_lost(self, subscription: Endpoint, count: int) -> None:
            lost.append(count)

    pair.near.observe(Notes())
    _, port = publisher(pair)
    items: list[Item] = []
    pair.near.subscribe(SUBSCRIPTION, String, items.append, shared=False)
    pair.settle()
    port.send(String(data="new"), 0, port.initial_sequence + 1)
    pair.settle()
    assert [message_of(item).data for item in items] == ["new"]
    assert lost == []


class Station:
    """A node on the network and its executor."""

    def __init__(self, context: Context, name: str) -> None:
        self.node = Node(name, context=context)
        self._executor = Executor(context=context)
        self._executor.add_node(self.node)

    def step(self) -> None:
        self._executor.spin_once(timeout_sec=0.0)


@pytest.fixture
def stations(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Station, Station]]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    with Context(transport="zenoh") as here, Context(transport="zenoh") as there:
        yield Station(here, "here"), Station(there, "there")


def test_recreated_publishers_and_clients_work(
    stations: tuple[Station, Station],
) -> None:
    here, there = stations
    received: list[str] = []
    there.node.create_subscription(String, "t", lambda m: received.append(m.data), 10)

    def add(request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    there.node.create_service(AddTwoInts, "add", add)
    names = set()

    def look(condition: Any, what: str) -> None:
        def goes() -> bool:
            here.step()
            there.step()
            return bool(condition())

        until(goes, what)

    for number in range(3):
        publisher = here.node.create_publisher(String, "t", 10)
        client = here.node.create_client(AddTwoInts, "add")
        names.add((publisher.endpoint.gid, client.endpoint.gid))
        look(publisher.get_subscription_count, "the subscription")
        look(client.service_is_ready, "the server")
        publisher.publish(String(data=str(number)))
        future = client.call_async(AddTwoInts.Request(a=number))
        look(lambda: len(received) == number + 1, "the message")  # noqa: B023 - called at once
        look(future.done, "the reply")
        assert future.result().sum == number
        here.node.destroy_client(client)
        here.node.destroy_publisher(publisher)
    assert received == ["0", "1", "2"]
    assert len(names) == 1


def test_a_recreated_node_reuses_its_tokens(
    stations: tuple[Station, Station],
) -> None:
    context = stations[0].node.context
    graph = stations[1].node.context.graph

    def seen() -> set[bytes]:
        return {end.gid for end in graph.service_endpoints(node="/again")}

    names = []
    for _ in range(2):
        node = Node("again", context=context)
        gids = {service.endpoint.gid for service in node.services}
        names.append(gids)
        until(lambda: gids <= seen(), "its services")  # noqa: B023 - called at once
        node.destroy_node()
        until(lambda: not seen(), "its end")
    assert names[0] == names[1]
