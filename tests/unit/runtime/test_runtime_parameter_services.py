"""Parameters and logger levels over services; the parameter client."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from navette.errors import FileFormatError, ParameterError
from navette.msgs.rcl_interfaces.msg import (
    LoggerLevel,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
)
from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.msgs.rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from navette.runtime import (
    Future,
    LoggingSeverity,
    MutuallyExclusiveCallbackGroup,
    Node,
    Parameter,
)
from navette.runtime.parameter import (
    get_parameter_value,
    parameter_dict_from_yaml_file,
)
from navette.runtime.parameter_client import AsyncParameterClient
from navette.runtime.parameter_event_handler import ParameterEventHandler
from navette.runtime.testing import GraphHarness

T = Parameter.Type
Ask = Callable[[Future[Any]], Any]


@pytest.fixture
def node(graph: GraphHarness) -> Node:
    node = graph.add(Node("n", namespace="ns", context=graph.context))
    node.declare_parameter("speed", 1.5)
    node.declare_parameter("count", 3)
    node.declare_parameter("pid.p", 2.0)
    node.declare_parameter("limit", 1, ParameterDescriptor(read_only=True))
    node.declare_parameter("unset", T.STRING)
    node.declare_parameter("any", 1, ParameterDescriptor(dynamic_typing=True))
    return node


@pytest.fixture
def client(graph: GraphHarness, node: Node) -> AsyncParameterClient:
    return AsyncParameterClient(graph.node, "ns/n")


@pytest.fixture
def ask(graph: GraphHarness) -> Ask:
    def wait(future: Future[Any]) -> Any:
        graph.executor.spin_until_future_complete(future, 1.0)
        return future.result()

    return wait


def test_every_node_serves_its_parameters(graph: GraphHarness, node: Node) -> None:
    names = [name for name, _ in node.get_service_names_and_types_by_node("n", "ns")]
    assert names == [
        f"/ns/n/{name}"
        for name in (
            "describe_parameters",
            "get_parameter_types",
            "get_parameters",
            "get_type_description",
            "list_parameters",
            "set_parameters",
            "set_parameters_atomically",
        )
    ]
    silent = Node("silent", context=graph.context, start_parameter_services=False)
    assert [each.service_name for each in silent.services] == [
        "/silent/get_type_description"
    ]


def test_get(client: AsyncParameterClient, ask: Ask) -> None:
    values = ask(client.get_parameters(["count", "pid.p"])).values
    assert values == [
        ParameterValue(type=2, integer_value=3),
        ParameterValue(type=3, double_value=2.0),
    ]
    assert ask(client.get_parameters(["count", "missing"])).values == []
    assert ask(client.get_parameters(["unset"])).values == []


def test_types_and_descriptions(client: AsyncParameterClient, ask: Ask) -> None:
    types = ask(client.get_parameter_types(["count", "speed"])).types
    assert list(types) == [T.INTEGER, T.DOUBLE]
    assert len(ask(client.get_parameter_types(["missing"])).types) == 0
    described = ask(client.describe_parameters(["limit"])).descriptors
    assert (described[0].name, described[0].read_only) == ("limit", True)
    assert ask(client.describe_parameters(["missing"])).descriptors == []


def test_list(client: AsyncParameterClient, ask: Ask) -> None:
    result = ask(client.list_parameters(["pid"], depth=2)).result
    assert (result.names, result.prefixes) == (["pid.p"], ["pid"])
    assert "speed" in ask(client.list_parameters()).result.names


def test_set(client: AsyncParameterClient, ask: Ask, node: Node) -> None:
    results = ask(
        client.set_parameters(
            [
                Parameter("count", T.INTEGER, 4),
                Parameter("limit", T.INTEGER, 2).to_parameter_msg(),
                Parameter("missing", T.INTEGER, 2),
                ParameterMsg(name="count", value=ParameterValue(type=77)),
            ]
        )
    ).results
    assert [result.successful for result in results] == [True, False, False, False]
    assert "read-only" in results[1].reason
    assert "not declared on node /ns/n (known: any, count" in results[2].reason
    assert "type 77; known: 0 … 9" in results[3].reason
    assert node.get_parameter("count").value == 4


def test_set_all_or_none(client: AsyncParameterClient, ask: Ask, node: Node) -> None:
    both = [Parameter("count", T.INTEGER, 9), Parameter("limit", T.INTEGER, 9)]
    assert not ask(client.set_parameters_atomically(both)).result.successful
    assert node.get_parameter("count").value == 3
    assert ask(client.set_parameters_atomically(both[:1])).result.successful
    assert node.get_parameter("count").value == 9


def test_delete(client: AsyncParameterClient, ask: Ask, node: Node) -> None:
    results = ask(client.delete_parameters(["any", "count"])).results
    assert [result.successful for result in results] == [True, False]
    assert not node.has_parameter("any")


def test_the_callback_receives_the_future(
    graph: GraphHarness, client: AsyncParameterClient
) -> None:
    seen: list[Any] = []
    client.get_parameters(["count"], callback=lambda f: seen.append(f.result()))
    graph.run_for(0.1)
    assert seen[0].values[0].integer_value == 3


def test_waiting_for_the_services(graph: GraphHarness) -> None:
    client = AsyncParameterClient(graph.node, "/late")
    assert not client.wait_for_services(timeout_sec=0.5)
    graph.node.create_timer(1.0, lambda: Node("late", context=graph.context))
    assert client.wait_for_services()
    assert client.services_are_ready()


def test_a_callback_calls_the_services_of_its_own_node(
    graph: GraphHarness, node: Node
) -> None:
    client = AsyncParameterClient(node, "n")
    seen: list[int] = []

    async def look() -> None:
        seen.append((await client.get_parameters(["count"])).values[0].integer_value)

    # Of a group of its own: the services are in the default one, which an await holds.
    node.create_timer(1.0, look, MutuallyExclusiveCallbackGroup())
    graph.run_for(1.5)
    assert seen == [3]


FILE = """
/**:
  ros__parameters: {count: 1, speed: 0.5}
/ns/n:
  ros__parameters: {count: 7, pid: {p: 4.0}}
"""


def test_parameter_files(
    client: AsyncParameterClient, ask: Ask, node: Node, tmp_path: Path
) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(FILE)
    assert all(r.successful for r in ask(client.load_parameter_file(str(path))).results)
    assert node.get_parameter("count").value == 7
    assert node.get_parameter("speed").value == 1.5
    loading = client.load_parameter_file_atomically(str(path), use_wildcard=True)
    assert ask(loading).result.successful
    assert node.get_parameter("speed").value == 0.5
    found = parameter_dict_from_yaml_file(path, target_nodes=["ns/n"], namespace="a.")
    assert list(found) == ["a.count", "a.pid.p"]
    with pytest.raises(ParameterError, match=r"nothing for /m; nodes: /\*\*, /ns/n"):
        parameter_dict_from_yaml_file(path, target_nodes=["m"])
    path.write_text("/**:\n  ros__parameters: {count: 1}\n")
    with pytest.raises(ParameterError, match="no selected parameters"):
        parameter_dict_from_yaml_file(path)
    with pytest.raises(FileFormatError, match="cannot be read"):
        parameter_dict_from_yaml_file(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("text", "kind"), [("1", T.INTEGER), ("1.5", T.DOUBLE), ("on", T.BOOL), ("x", 4)]
)
def test_a_text_as_value(text: str, kind: int) -> None:
    assert get_parameter_value(text).type == kind


def test_events(
    graph: GraphHarness, client: AsyncParameterClient, node: Node, ask: Ask
) -> None:
    events: list[str] = []
    client.on_parameter_event(lambda event: events.append(event.node))
    ask(client.set_parameters([Parameter("count", T.INTEGER, 5)]))
    graph.run_for(0.1)
    assert events == ["/ns/n"]


def test_event_handler(graph: GraphHarness, node: Node) -> None:
    handler = ParameterEventHandler(node)
    seen: list[Any] = []
    own = handler.add_parameter_callback(
        "count", "", lambda p: seen.append(p.value.integer_value)
    )
    named = handler.add_parameter_callback("count", "n", lambda p: seen.append("named"))
    handler.add_parameter_callback("count", "/other", lambda p: seen.append("wrong"))
    every = handler.add_parameter_event_callback(lambda event: seen.append(event.node))
    node.set_parameters([Parameter("count", T.INTEGER, 8)])
    graph.run_for(0.1)
    assert seen == ["named", 8, "/ns/n"]
    handler.remove_parameter_callback(own)
    handler.remove_parameter_callback(named)
    handler.remove_parameter_event_callback(every)
    with pytest.raises(RuntimeError, match="no such parameter callback"):
        handler.remove_parameter_callback(own)
    with pytest.raises(RuntimeError, match="no such parameter event callback"):
        handler.remove_parameter_event_callback(every)
    node.set_parameters([Parameter("count", T.INTEGER, 9)])
    graph.run_for(0.1)
    assert len(seen) == 3
    event = ParameterEvent(node="/a", new_parameters=[ParameterMsg(name="x")])
    assert handler.get_parameter_from_event(event, "x", "/a") is not None
    assert handler.get_parameter_from_event(event, "x", "/b") is None
    handler.destroy()


def test_logger_levels(graph: GraphHarness) -> None:
    graph.add(Node("logs", context=graph.context, enable_logger_service=True))
    set_levels = graph.node.create_client(SetLoggerLevels, "/logs/set_logger_levels")
    get_levels = graph.node.create_client(GetLoggerLevels, "/logs/get_logger_levels")
    wanted = [LoggerLevel(name="logs", level=10), LoggerLevel(name="logs", level=11)]
    results = set_levels.call(SetLoggerLevels.Request(levels=wanted)).results
    assert [result.successful for result in results] == [True, False]
    assert "level 11; known: [0, 10" in results[1].reason
    levels = get_levels.call(GetLoggerLevels.Request(names=["logs", "x"])).levels
    assert [level.level for level in levels] == [
        LoggingSeverity.DEBUG,
        LoggingSeverity.UNSET,
    ]
