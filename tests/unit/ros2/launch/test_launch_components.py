"""Loading, listing and unloading nodes by ROS 2's composition services."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import navette
from navette.errors import ParameterError
from navette.msgs.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from navette.ros2.launch.components import ComponentManager
from navette.runtime import (
    Context,
    Executor,
    LoggingSeverity,
    Node,
    Parameter,
    VirtualClock,
)
from navette.runtime.arguments import parse_ros_arguments
from navette.runtime.context import get_default_context, reset_default_context

MODULE = """
from navette.runtime import Node

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.declare_parameter("rate", 1.0)
        self.ticks = 0
        self.create_timer(1.0, self.tick)

    def tick(self):
        self.ticks += 1

class Broken(Node):
    def __init__(self, context):
        super().__init__("broken", context=context)
        raise ZeroDivisionError("of its own")
"""


class Container:
    """A container and a client of its services."""

    def __init__(self, context: Context) -> None:
        self.executor = Executor(context=context)
        self.node = Node("container", context=context)
        self.executor.add_node(self.node)
        self.manager = ComponentManager(self.node, self.executor)

    def ask(self, kind: Any, name: str, **fields: Any) -> Any:
        client = self.node.create_client(kind, f"~/_container/{name}")
        return client.call(kind.Request(**fields), timeout_sec=1.0)

    def load(self, plugin: str, **fields: Any) -> Any:
        fields = {"package_name": "components_here", "plugin_name": plugin, **fields}
        return self.ask(LoadNode, "load_node", **fields)

    def listed(self) -> list[tuple[int, str]]:
        answer = self.ask(ListNodes, "list_nodes")
        return list(zip(answer.unique_ids, answer.full_node_names, strict=True))


@pytest.fixture
def container(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Container]:
    (tmp_path / "components_here.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    reset_default_context()
    navette.init(args=["--ros-args", "-r", "__ns:=/mine"], clock=VirtualClock())
    yield Container(get_default_context())
    navette.shutdown()
    reset_default_context()


def test_load_list_and_unload(container: Container) -> None:
    first = container.load("components_here::Talker")
    assert first.success, first.error_message
    # The container's own arguments are not the node's.
    assert (first.unique_id, first.full_node_name) == (1, "/talker")
    second = container.load(
        "components_here::Talker",
        node_name="other",
        node_namespace="/ns",
        log_level=int(LoggingSeverity.ERROR),
        remap_rules=["chatter:=news"],
        parameters=[Parameter("rate", value=2.5).to_parameter_msg()],
    )
    assert (second.unique_id, second.full_node_name) == (2, "/ns/other")
    node: Any = container.manager.nodes()[2]
    assert node.get_parameter("rate").value == 2.5
    assert node.resolve_topic_name("chatter") == "/ns/news"
    assert node.get_logger().get_effective_level() is LoggingSeverity.ERROR
    assert container.listed() == [(1, "/talker"), (2, "/ns/other")]
    container.executor.spin_for(3_500_000_000)
    assert node.ticks == 3
    assert container.ask(UnloadNode, "unload_node", unique_id=2).success
    assert container.listed() == [(1, "/talker")]
    names = container.node.get_fully_qualified_node_names()
    assert "/ns/other" not in names


@pytest.mark.parametrize(
    ("plugin", "fields", "reason"),
    [
        ("components_here::Listener", {}, "Listener.*known: Broken, Node, Talker"),
        ("nowhere::Talker", {}, "no Python module 'nowhere'"),
        ("components_here::Broken", {}, "ZeroDivisionError: of its own"),
        ("components_here::Talker", {"node_name": "a b"}, "a b"),
        (
            "components_here::Talker",
            {"parameters": [Parameter("speed", value=1).to_parameter_msg()]},
            "speed",
        ),
    ],
)
def test_a_failed_load_leaves_no_node(
    container: Container, plugin: str, fields: dict[str, Any], reason: str
) -> None:
    answer = container.load(plugin, **fields)
    assert not answer.success
    assert re.search(reason, answer.error_message)
    assert container.listed() == []
    assert container.node.get_fully_qualified_node_names() == ["/mine/container"]


def test_an_unknown_id(container: Container) -> None:
    container.load("components_here::Talker")
    answer = container.ask(UnloadNode, "unload_node", unique_id=7)
    assert not answer.success
    assert "'7'; known: 1" in answer.error_message


def test_components_of_a_launch_file_are_listed(container: Container) -> None:
    arguments = parse_ros_arguments(
        ["--ros-args", "-r", "__node:=named", "-p", "rate:=3.0"]
    )
    number = container.manager.load(
        "components_here", "components_here:Talker", arguments, "launch file"
    )
    assert container.listed() == [(number, "/named")]
    wrong = parse_ros_arguments(["--ros-args", "-p", "speed:=3.0"])
    with pytest.raises(ParameterError, match="speed"):
        container.manager.load("", "components_here:Talker", wrong, "launch file")
