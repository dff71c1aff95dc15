"""ros2topic.api and ros2cli.node: topics of the graph, classes, QoS by short words."""

import argparse

import pytest

from navette.msgs.std_msgs.msg import String
from navette.ros2.packages.ros2cli.node.strategy import NodeStrategy, add_arguments
from navette.ros2.packages.ros2topic.api import (
    get_msg_class,
    get_topic_names,
    get_topic_names_and_types,
    import_message_type,
    positive_float,
    qos_profile_from_short_keys,
    unsigned_int,
)
from navette.runtime import Node
from navette.runtime.qos import DurabilityPolicy, ReliabilityPolicy
from navette.runtime.testing import GraphHarness


def test_topics_and_their_classes() -> None:
    with GraphHarness() as graph:
        node = graph.add(Node("tool", context=graph.context, namespace="/robot"))
        node.create_publisher(String, "chatter", 1)
        node.create_publisher(String, "_hidden", 1)
        topics = dict(get_topic_names_and_types(node=node))
        assert topics["/robot/chatter"] == ["std_msgs/msg/String"]
        assert "/robot/_hidden" not in topics
        assert "/robot/_hidden" in get_topic_names(
            node=node, include_hidden_topics=True
        )
        assert get_msg_class(node, "chatter") is String
        assert get_msg_class(node, "/nothing") is None


def test_classes_by_name() -> None:
    assert import_message_type("/a", "std_msgs/String") is String
    with pytest.raises(RuntimeError, match=r"/a.*std_msgs/msg/Strin"):
        import_message_type("/a", "std_msgs/msg/Strin")


def test_qos_by_short_words() -> None:
    profile = qos_profile_from_short_keys(
        "sensor_data", reliability="reliable", durability="transient_local", depth=3
    )
    assert profile.reliability == ReliabilityPolicy.RELIABLE
    assert profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert profile.depth == 3


def test_numbers_on_a_command_line() -> None:
    assert (unsigned_int("0"), positive_float("0.5")) == (0, 0.5)
    with pytest.raises(argparse.ArgumentTypeError, match="expected an integer"):
        unsigned_int("-1")


def test_a_tool_has_a_node_for_a_while() -> None:
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    args = parser.parse_args(["--spin-time", "0.01"])
    with NodeStrategy(args) as node:
        assert node.get_name().startswith("_ros2cli")
        assert isinstance(node.get_topic_names_and_types(), list)
    with pytest.raises(RuntimeError, match="exists within"):
        node.get_name()
