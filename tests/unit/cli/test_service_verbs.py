"""``navette service``: texts as of ros2 service, partial YAML, what goes wrong."""

import json
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest
from verb_world import World, world

from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_srvs.srv import SetBool
from navette.runtime import Node
from navette.runtime.qos import qos_profile_system_default
from navette.runtime.service_introspection import ServiceIntrospectionState

ADD = "example_interfaces/srv/AddTwoInts"
CALLED = """\
requester: making request: example_interfaces.srv.AddTwoInts_Request(a=2, b=3)

response:
example_interfaces.srv.AddTwoInts_Response(sum=5)

"""
EVENT = """\
info:
  event_type: REQUEST_RECEIVED
  stamp:
    sec: 0
    nanosec: 0
"""


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        yield here


@pytest.fixture
def adder(here: World) -> Node:
    """Serves /add, /enable and something hidden."""
    node = Node("adder", context=here.context, start_parameter_services=False)
    node.create_service(AddTwoInts, "add", _add)
    node.create_service(SetBool, "enable", lambda request, response: response)
    node.create_service(SetBool, "_own/enable", lambda request, response: response)
    return here.graph.add(node)


def _add(request: Any, response: Any) -> Any:
    response.sum = request.a + request.b
    return response


NAMES = "/add\n/adder/get_type_description\n/enable\n"


def test_list(here: World, adder: Node) -> None:
    assert here.read("service", "list") == NAMES
    assert here.read("service", "list", "-a") == "/_own/enable\n" + NAMES
    assert here.read("service", "list", "-c") == "3\n"
    typed = here.read("service", "list", "-t").splitlines()
    assert typed[0] == f"/add [{ADD}]"
    listed = json.loads(here.read("service", "list", "--json"))
    assert listed[0] == {"name": "/add", "types": [ADD]}


def test_type_and_find(here: World, adder: Node) -> None:
    assert here.read("service", "type", "/add") == f"{ADD}\n"
    assert here.read("service", "find", ADD) == "/add\n"
    assert here.read("service", "find", "std_srvs/SetBool", "-c") == "1\n"
    done = here.run("service", "find", "std_srvs/srv/Empty")
    assert done == ("", "navette: no service has type std_srvs/srv/Empty\n", 1)


def test_info(here: World, adder: Node) -> None:
    adder.create_client(AddTwoInts, "add")
    text = f"Type: {ADD}\nClients count: 1\nServices count: 1\n"
    assert here.read("service", "info", "add") == text
    verbose = here.read("service", "info", "add", "-v")
    assert verbose.splitlines()[1:] == [
        "Clients count: 1",
        "    /adder",
        "Services count: 1",
        "    /adder",
    ]
    info = json.loads(here.read("service", "info", "add", "--json"))
    assert info["servers"] == ["/adder"]


@pytest.mark.parametrize("verb", ["type", "info"])
def test_a_mistyped_service(here: World, adder: Node, verb: str) -> None:
    done = here.run("service", verb, "/ad")
    assert (done.out, done.code) == ("", 1)
    assert done.err == "navette: no server of /ad; did you mean /add?\n"


@pytest.mark.parametrize(
    "words",
    [
        ["/add", ADD, "{a: 2, b: 3}"],
        ["add", "example_interfaces/AddTwoInts", "{a: 2, b: 3}"],
        ["/add", "{a: 2, b: 3}"],
        ["/add", "a: 2\nb: 3"],
    ],
)
def test_call(here: World, adder: Node, words: list[str]) -> None:
    assert here.read("service", "call", *words) == CALLED


def test_call_with_partial_yaml_and_for_programs(here: World, adder: Node) -> None:
    printed = here.read("service", "call", "/add", "{b: 3}", "--json")
    assert json.loads(printed) == {"sum": 3}
    assert json.loads(here.read("service", "call", "/add", "--json")) == {"sum": 0}


def test_call_from_standard_input(here: World, adder: Node) -> None:
    done = here.run("service", "call", "/add", "--stdin", "--json", stdin="a: 4\nb: 5")
    assert json.loads(done.out) == {"sum": 9}


def test_call_at_a_rate(here: World, adder: Node) -> None:
    """Ctrl-C ends it: here the server's third call does."""
    calls = []

    def count(request: Any, response: Any) -> Any:
        calls.append(adder.get_clock().now().nanoseconds)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return response

    adder.create_service(SetBool, "count", count)
    done = here.run("service", "call", "/count", "-r", "2")
    assert done.code == 130
    assert done.out.count("response:\n") == 2
    periods_ns = [after - before for before, after in pairwise(calls)]
    assert periods_ns == [500_000_000, 500_000_000]


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["/add", "{c: 1}"], "has no field 'c'; its fields: a, b"),
        (["/add", "{a: 1"], "is not YAML"),
        (["/add", "[1, 2]"], "is expected to be a dictionary"),
        (["/add", "{a: one}"], "Request.a: 'one' is str, expected an integer"),
        (["/add", ADD, "{a: 1}", "{b: 1}"], "quote the YAML"),
        (["/add", "-r", "0"], "--rate 0 is not above 0 (in Hz)"),
    ],
)
def test_a_wrong_request_is_not_sent(
    here: World, adder: Node, words: list[str], reason: str
) -> None:
    done = here.run("service", "call", *words)
    assert (done.out, done.code) == ("", 2)
    assert reason in done.err


def test_call_of_another_type(here: World, adder: Node) -> None:
    done = here.run("service", "call", "/add", "std_srvs/srv/SetBool")
    assert done.code == 1
    assert done.err == (
        f"navette: service /add has type {ADD}, not std_srvs/srv/SetBool\n"
    )


def test_call_of_an_unknown_type(here: World, adder: Node) -> None:
    done = here.run("service", "call", "/add", "no_such/srv/Type")
    assert done.code == 1
    assert done.err == "navette: type no_such/srv/Type is not installed\n"
    done = here.run("service", "call", "/add", "std_srvs/srv/SetBol")
    assert done.err.endswith(" not installed; did you mean std_srvs/srv/SetBool?\n")


def test_call_gives_up(here: World, adder: Node) -> None:
    done = here.run("service", "call", "/ad", "-w", "2")
    assert (done.out, done.code) == ("", 1)
    assert done.err == (
        "waiting for service /ad to become available; did you mean /add?\n"
        "navette: no server of /ad; did you mean /add?\n"
    )
    assert here.graph.now_ns == 2_000_000_000


def test_call_waits_for_the_server(here: World, adder: Node) -> None:
    adder.create_timer(
        1.0, lambda: adder.create_service(AddTwoInts, "late", _add)
    ).reset()
    done = here.run("service", "call", "/late", "-w", "1.5", "--json")
    assert json.loads(done.out) == {"sum": 0}


def test_call_of_a_server_that_fails(here: World, adder: Node) -> None:
    here.graph.executor.remove_node(adder)
    done = here.run("service", "call", "/add", "-w", "1")
    assert done.code == 1
    assert done.err == "navette: service /add: no response in 1 s (-w S waits longer)\n"


def test_echo(here: World, adder: Node) -> None:
    (server,) = [s for s in adder.services if s.service_name == "/add"]
    server.configure_introspection(
        adder.get_clock(),
        qos_profile_system_default,
        ServiceIntrospectionState.CONTENTS,
    )
    client = adder.create_client(AddTwoInts, "add")
    adder.create_timer(1.0, lambda: client.call_async(AddTwoInts.Request(a=1)))
    done = here.run("service", "echo", "/add", "--once")
    event = EVENT.replace("sec: 0\n", "sec: 1\n", 1)
    assert done.out.startswith(event)
    assert "\nrequest:\n- a: 1\n  b: 0\nresponse: []\n---\n" in done.out
    as_csv = here.read("service", "echo", "/add", "--csv", "--once")
    assert as_csv.startswith("1,2,0,")


def test_echo_reports_that_introspection_is_off(here: World, adder: Node) -> None:
    done = here.run("service", "echo", "/add")
    assert (
        "no publisher on /add/_service_event: enable service introspection" in done.err
    )
