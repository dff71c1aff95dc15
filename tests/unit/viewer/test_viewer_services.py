"""Services for clients: advertisement, calls, refusals; in the hub and end to end."""

import json
import struct
from collections.abc import Iterator
from typing import Any

import pytest
from viewer_fakes import DirectCommands, RecordingProgram, sent
from viewer_harness import Client, Program

from navette.msgs import deserialize, serialize
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import Context, Node
from navette.viewer.hub import Hub
from navette.viewer.outbox import Outbox
from navette.viewer.replies import ConnectionGraph, OfferedService
from navette.viewer.session import CallId, Session

RESET = OfferedService("/reset", "std_srvs/srv/Trigger", "", "bool success")
PAUSE = OfferedService("/pause", "std_srvs/srv/SetBool", "bool data", "bool success")


def call_frame(service: int, call: int, encoding: str, data: bytes) -> bytes:
    head = struct.pack("<BIII", 2, service, call, len(encoding))
    return head + encoding.encode() + data


@pytest.fixture
def program() -> RecordingProgram:
    return RecordingProgram()


@pytest.fixture
def hub(program: RecordingProgram) -> Hub:
    hub = Hub(program, DirectCommands(), name="test", session_id="1")
    hub.services.set_services([RESET])
    return hub


def join(hub: Hub) -> Session:
    session = hub.join(Outbox())
    sent(session.outbox)
    return session


def test_services_are_advertised_to_clients_that_join_and_to_those_there(
    hub: Hub,
) -> None:
    first = hub.join(Outbox())
    (offer,) = sent(first.outbox)[-1]["services"]
    assert (offer["id"], offer["name"], offer["type"]) == (1, "/reset", RESET.type_name)
    assert offer["response"]["schemaName"] == "std_srvs/srv/Trigger_Response"
    assert offer["responseSchema"] == offer["response"]["schema"] == "bool success"
    hub.services.set_services([PAUSE])
    gone, added = sent(first.outbox)
    assert gone == {"op": "unadvertiseServices", "serviceIds": [1]}
    assert [each["id"] for each in added["services"]] == [2]
    hub.services.set_services([PAUSE])
    assert not first.outbox


def test_a_call_is_forwarded_and_its_response_returned(
    hub: Hub, program: RecordingProgram
) -> None:
    session, other = join(hub), join(hub)
    hub.receive(session, call_frame(1, 9, "cdr", b"xyz"))
    call_id = CallId(session.id, 1, 9)
    assert program.take() == [("call", call_id, "/reset", "cdr", b"xyz")]
    hub.services.responded(call_id, "cdr", b"done")
    (frame,) = sent(session.outbox)
    assert frame == struct.pack("<BIII", 3, 1, 9, 3) + b"cdrdone"
    assert not other.outbox
    assert not session.calls


@pytest.mark.parametrize(
    ("service", "encoding", "problem"),
    [(7, "cdr", "unknown service id 7"), (1, "xml", "encoding 'xml'; known: cdr")],
)
def test_a_refused_call_states_why(
    hub: Hub, program: RecordingProgram, service: int, encoding: str, problem: str
) -> None:
    session = join(hub)
    hub.receive(session, call_frame(service, 4, encoding, b""))
    (failure,) = sent(session.outbox)
    assert (failure["op"], failure["callId"]) == ("serviceCallFailure", 4)
    assert problem in failure["message"]
    assert program.take() == []


def test_calls_without_a_response_are_bounded_per_client(
    hub: Hub, program: RecordingProgram
) -> None:
    session, other = join(hub), join(hub)
    for number in range(100):
        hub.receive(session, call_frame(1, number, "cdr", b""))
    hub.receive(session, call_frame(1, 0, "cdr", b""))
    assert len(program.take()) == 32
    failures = [each["message"] for each in sent(session.outbox)]
    assert failures == ["32 calls have no response yet"] * 68 + ["call id 0 is in use"]
    hub.receive(other, call_frame(1, 0, "cdr", b""))
    assert len(program.take()) == 1
    hub.services.failed(CallId(session.id, 1, 5), "no response in 30 s")
    (failure,) = sent(session.outbox)
    assert failure["message"] == "no response in 30 s"
    hub.receive(session, call_frame(1, 5, "cdr", b""))
    assert len(program.take()) == 1


def test_the_response_to_a_client_that_left_is_dropped(hub: Hub) -> None:
    session = join(hub)
    hub.receive(session, call_frame(1, 1, "cdr", b""))
    hub.leave(session)
    hub.services.responded(CallId(session.id, 1, 1), "cdr", b"")
    assert not session.outbox


def test_the_connection_graph_lists_servers(hub: Hub) -> None:
    session = join(hub)
    hub.receive(session, json.dumps({"op": "subscribeConnectionGraph"}))
    hub.set_graph(ConnectionGraph({}, {}, {"/reset": ("/sim",)}))
    hub.set_graph(ConnectionGraph({}, {}, {}))
    added, removed = sent(session.outbox)
    services = [{"name": "/reset", "providerIds": ["/sim"]}]
    assert added["advertisedServices"] == services
    assert removed["removedServices"] == ["/reset"]


# End to end


class Calculator(Node):
    """Serves a sum, and a service that fails."""

    def __init__(self, context: Context) -> None:
        super().__init__("calculator", context=context)
        self.create_service(AddTwoInts, "/add", self.add)
        self.create_service(Trigger, "/broken", self.break_down)

    def add(self, request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    def break_down(self, request: Any, response: Any) -> Any:
        response.success, response.message = False, "out of order"
        return response


@pytest.fixture
def running() -> Iterator[Program]:
    with Program(Calculator) as program:
        yield program


class Caller:
    """A protocol client that calls services."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._services: dict[str, dict[str, Any]] = {}

    def service(self, name: str) -> dict[str, Any]:
        while name not in self._services:
            offers = self._client.wait_for_op("advertiseServices")["services"]
            self._services |= {each["name"]: each for each in offers}
        return self._services[name]

    def call(self, name: str, encoding: str, data: bytes) -> Any:
        """Return the payload of the response, or the failure."""
        service = self.service(name)["id"]
        self._client.socket.send(call_frame(service, 3, encoding, data))
        return self._client.wait_for(
            lambda frame: (
                (isinstance(frame, tuple) and frame[0] == 3)
                or (isinstance(frame, dict) and frame["op"] == "serviceCallFailure")
            )
        )

    def names(self) -> set[str]:
        return set(self._services)


@pytest.fixture
def caller(running: Program) -> Iterator[Caller]:
    with Client(running.address) as client:
        yield Caller(client)


def test_a_service_is_called_in_cdr_and_json(caller: Caller) -> None:
    data = serialize(AddTwoInts.Request(a=2, b=40))
    opcode, service, call, encoding, payload = caller.call("/add", "cdr", data)
    assert (opcode, service, call) == (3, caller.service("/add")["id"], 3)
    assert (encoding, deserialize(payload, AddTwoInts.Response).sum) == ("cdr", 42)
    reply = caller.call("/add", "json", b'{"a": 1, "b": 2}')
    assert reply[3:] == ("json", b'{"sum": 3}')


def test_services_that_every_node_has_are_not_listed(caller: Caller) -> None:
    caller.service("/add")
    assert not any("parameters" in name for name in caller.names())


@pytest.mark.parametrize(
    ("encoding", "data"),
    [
        ("cdr", b""),
        ("cdr", b"\xff" * 40),
        ("json", b"["),
        ("json", b"[" * 100_000),
        ("json", b'{"a": 1e999, "b": NaN}'),
        ("json", b'{"c": 1}'),
    ],
)
def test_a_hostile_request_fails_and_the_next_one_succeeds(
    caller: Caller, encoding: str, data: bytes
) -> None:
    failure = caller.call("/add", encoding, data)
    assert failure["op"] == "serviceCallFailure"
    assert failure["message"].startswith("/add: ")
    assert caller.call("/add", "json", b"{}")[4] == b'{"sum": 0}'
