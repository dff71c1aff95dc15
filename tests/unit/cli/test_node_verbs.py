"""``navette node``: the texts that ros2 node prints."""

import json
from collections.abc import Iterator

import pytest
from verb_world import World, world

from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import String
from navette.runtime import Node
from navette.runtime.action import ActionServer

INFO = """\
/ns/talker
  Subscribers:
    /received: std_msgs/msg/String
  Publishers:
    /chatter: std_msgs/msg/String
    /parameter_events: rcl_interfaces/msg/ParameterEvent
  Service Servers:
    /ns/talker/get_type_description: type_description_interfaces/srv/GetTypeDescription
  Service Clients:
    /add: example_interfaces/srv/AddTwoInts
  Action Servers:
    /count: example_interfaces/action/Fibonacci
  Action Clients:

"""


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        talker = _node(here, "talker", "/ns")
        talker.create_publisher(String, "/chatter", 10)
        talker.create_subscription(String, "/received", lambda _: None, 10)
        talker.create_client(AddTwoInts, "/add")
        ActionServer(talker, Fibonacci, "/count", lambda goal: Fibonacci.Result())
        _node(here, "listener")
        _node(here, "_hidden")
        yield here


def _node(here: World, name: str, namespace: str = "") -> Node:
    node = Node(
        name,
        namespace=namespace,
        context=here.context,
        enable_rosout=False,
        start_parameter_services=False,
    )
    return here.graph.add(node)


def test_list(here: World) -> None:
    assert here.read("node", "list") == "/listener\n/ns/talker\n"
    assert here.read("node", "list", "-a") == "/_hidden\n/listener\n/ns/talker\n"
    assert here.read("node", "list", "-c") == "2\n"
    assert json.loads(here.read("node", "list", "--json")) == [
        "/listener",
        "/ns/talker",
    ]


def test_list_warns_of_names_that_are_there_twice(here: World) -> None:
    _node(here, "listener")
    done = here.run("node", "list")
    assert done.out == "/listener\n/listener\n/ns/talker\n"
    assert "some nodes share a name" in done.err


@pytest.mark.parametrize("name", ["/ns/talker", "ns/talker"])
def test_info(here: World, name: str) -> None:
    assert here.read("node", "info", name) == INFO


def test_info_with_hidden_endpoints(here: World) -> None:
    shown = here.read("node", "info", "/ns/talker", "--include-hidden")
    assert "    /count/_action/feedback: " in shown
    assert "    /count/_action/send_goal: " in shown


def test_info_for_programs(here: World) -> None:
    info = json.loads(here.read("node", "info", "/ns/talker", "--json"))
    assert info["node"] == "/ns/talker"
    assert info["subscribers"] == {"/received": ["std_msgs/msg/String"]}
    assert info["action_servers"] == {"/count": ["example_interfaces/action/Fibonacci"]}


@pytest.mark.parametrize(
    ("typed", "hint"),
    [("/talker", "did you mean /ns/talker?"), ("/listner", "did you mean /listener?")],
)
def test_a_mistyped_node(here: World, typed: str, hint: str) -> None:
    done = here.run("node", "info", typed)
    assert (done.out, done.code) == ("", 1)
    assert done.err == f"navette: no node {typed}; {hint}\n"


def test_without_running_nodes() -> None:
    with world() as here:
        assert here.read("node", "list") == ""
        done = here.run("node", "info", "/planner")
    assert done.code == 1
    assert done.err == (
        "navette: no node /planner: no nodes run with this ROS_DOMAIN_ID and"
        " NAVETTE_ROUTER\n"
    )


def test_an_empty_list_is_explained() -> None:
    with world() as here:
        domain = here.context.get_domain_id()
        nothing = f": no nodes run in domain {domain} (ROS_DOMAIN_ID)\n"
        for words, what in (
            (("node", "list"), "nodes"),
            (("service", "list"), "services"),
            (("action", "list"), "actions"),
            (("lifecycle", "nodes"), "managed nodes"),
            (("lifecycle", "get"), "managed nodes"),
        ):
            assert here.run(*words) == ("", f"no {what}{nothing}", 0)
        here.graph.add(Node("talker", context=here.context))
        assert here.run("action", "list") == ("", "no actions\n", 0)
        assert here.run("action", "list", "--json") == ("[]\n", "", 0)
