"""Graph resource names, with the tables of the ROS 2 design document."""

import pytest

from navette.errors import InvalidNameError, InvalidValueError
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Node, VirtualClock
from navette.runtime.names import (
    NodeRemapper,
    RemapRule,
    expand_topic_name,
    validate_full_topic_name,
    validate_namespace,
    validate_node_name,
    validate_topic_name,
)


@pytest.mark.parametrize(
    ("name", "node", "namespace", "expected"),
    [
        ("topic", "node", "/ns", "/ns/topic"),
        ("~/topic", "node", "/ns", "/ns/node/topic"),
        ("~", "node", "/ns", "/ns/node"),
        ("foo/topic", "node", "/ns", "/ns/foo/topic"),
        ("/topic", "node", "/ns", "/topic"),
        ("topic", "node", "/", "/topic"),
        ("~/topic", "node", "/", "/node/topic"),
        ("{node}/x", "node", "/ns", "/ns/node/x"),
        ("{ns}/x", "node", "/ns", "/ns/x"),
    ],
)
def test_expansion(name: str, node: str, namespace: str, expected: str) -> None:
    assert expand_topic_name(name, node, namespace) == expected


@pytest.mark.parametrize(
    "name",
    ["", "a b", "a//b", "a/", "1a", "/1a", "~a", "a/~/b", "{what}/x", "a-b", "ä", "/"],
)
def test_bad_topic_names(name: str) -> None:
    with pytest.raises(InvalidNameError):
        expand_topic_name(name, "node", "/ns")


@pytest.mark.parametrize("name", ["", "a/b", "1a", "a b", "a-b", "x" * 256])
def test_bad_node_names(name: str) -> None:
    with pytest.raises(InvalidNameError):
        validate_node_name(name)


@pytest.mark.parametrize("name", ["a", "/a/", "//a", "/1a", ""])
def test_bad_namespaces(name: str) -> None:
    with pytest.raises(InvalidNameError):
        validate_namespace(name)


def test_good_names() -> None:
    assert validate_node_name("_n1")
    assert validate_namespace("/a/b_c")
    assert validate_topic_name("~/a/b")
    assert validate_full_topic_name("/a/_b")


def test_the_error_marks_the_position() -> None:
    with pytest.raises(InvalidNameError) as caught:
        validate_topic_name("ab cd")
    assert "'ab cd'" in str(caught.value)
    assert caught.value.invalid_index == 2  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("rule", "name", "expected"),
    [
        ("chatter:=talk", "chatter", "/ns/talk"),
        ("chatter:=/talk", "chatter", "/talk"),
        ("/ns/chatter:=talk", "chatter", "/ns/talk"),
        ("chatter:=talk", "/ns/chatter", "/ns/talk"),
        ("chatter:=talk", "/chatter", "/chatter"),
        ("~/scan:=/scan", "~/scan", "/scan"),
        ("node:chatter:=talk", "chatter", "/ns/talk"),
        ("other:chatter:=talk", "chatter", "/ns/chatter"),
        ("rostopic://chatter:=talk", "chatter", "/ns/talk"),
    ],
)
def test_remapping(rule: str, name: str, expected: str) -> None:
    remapper = NodeRemapper([RemapRule.parse(rule)], "node", "/ns")
    assert remapper.resolve(name) == expected


def test_the_first_matching_rule_applies() -> None:
    rules = [RemapRule.parse("a:=b"), RemapRule.parse("a:=c")]
    assert NodeRemapper(rules, "n", "/").resolve("a") == "/b"


@pytest.mark.parametrize(
    ("rule", "topic", "service"),
    [
        ("rostopic://a:=b", "/b", "/a"),
        ("rosservice://a:=b", "/a", "/b"),
        ("n:rosservice://a:=rosservice://b", "/a", "/b"),
        ("a:=b", "/b", "/b"),
    ],
)
def test_rules_of_topics_or_services(rule: str, topic: str, service: str) -> None:
    remapper = NodeRemapper([RemapRule.parse(rule)], "n", "/")
    assert remapper.resolve("a") == topic
    assert remapper.resolve("a", is_service=True) == service


def test_only_expand_skips_remapping() -> None:
    remapper = NodeRemapper([RemapRule.parse("a:=b")], "n", "/")
    assert remapper.resolve("a", only_expand=True) == "/a"


@pytest.mark.parametrize(
    "text", ["a", "a:=", ":=b", "a b:=c", "1n:a:=b", "__node:=a/b"]
)
def test_bad_rules(text: str) -> None:
    with pytest.raises(InvalidValueError):
        RemapRule.parse(text)


def test_node_is_named_by_arguments() -> None:
    context = Context(clock=VirtualClock())
    context.init(
        ["--ros-args", "-r", "__node:=renamed", "-r", "__ns:=/robot", "-r", "a:=/b"]
    )
    node = Node("original", context=context)
    assert node.get_name() == "renamed"
    assert node.get_namespace() == "/robot"
    assert node.get_fully_qualified_name() == "/robot/renamed"
    assert node.get_logger().name == "robot.renamed"
    assert node.create_publisher(String, "a", 1).topic_name == "/b"
    assert node.create_publisher(String, "~/a", 1).topic_name == "/robot/renamed/a"
    own = Node("original", context=context, use_global_arguments=False)
    assert own.get_fully_qualified_name() == "/original"


def test_local_arguments_come_before_global_ones() -> None:
    context = Context(clock=VirtualClock())
    context.init(["--ros-args", "-r", "a:=global"])
    node = Node("n", context=context, cli_args=["--ros-args", "-r", "a:=local"])
    assert node.resolve_topic_name("a") == "/local"
    shorter = Node("m", context=context, cli_args=["-r", "a:=local"])
    assert shorter.resolve_service_name("a") == "/local"


def test_namespace_argument_needs_no_slash() -> None:
    node = Node("n", context=Context(clock=VirtualClock()), namespace="robot1")
    assert node.get_namespace() == "/robot1"
