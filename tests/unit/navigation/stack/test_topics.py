"""The table of topics and the nodes' declarations agree."""

import ast
from pathlib import Path

import pytest

import navette
from navette.msgs import get_interface, topics
from navette.msgs.topics import CHAIN, StackTopic
from navette.navigation.stack.stage_classes import node_classes
from navette.runtime import StageNode

SOURCE = Path(navette.__file__).parent
TABLE = {each.name: each for each in vars(topics).values() if type(each) is StackTopic}
NODES = dict(node_classes())


@pytest.mark.parametrize("topic", TABLE.values(), ids=lambda each: each.name)
def test_the_type_of_each_topic_exists(topic: StackTopic) -> None:
    assert get_interface(topic.type)


@pytest.mark.parametrize("node", NODES.values(), ids=lambda each: each.__name__)
def test_nodes_declare_type_and_qos_of_the_table(node: type[StageNode]) -> None:
    for port in (*node.INPUTS, *node.OUTPUTS):
        if port.topic.startswith("/"):  # the filter's inputs are parameters
            declared = StackTopic(port.topic, port.type, port.depth, port.latched)
            assert declared == TABLE[port.topic]


@pytest.mark.parametrize("link", CHAIN, ids=lambda each: each.stage)
def test_the_chain_is_that_of_the_nodes(link: topics.ChainLink) -> None:
    node = NODES[link.stage]
    assert link.reads.name in [port.topic for port in node.INPUTS]
    assert link.publishes.name in [port.topic for port in node.OUTPUTS]


def test_topic_names_are_written_once() -> None:
    """ROS 2's own names of tf and time may occur where ROS 2's API defines them."""
    own = TABLE.keys() - {"/tf", "/tf_static", "/clock"}
    for path in SOURCE.rglob("*.py"):
        if path != Path(topics.__file__):
            tree = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            literals = {each.value for each in tree if isinstance(each, ast.Constant)}
            found = own & literals
            assert not found, f"{path}: {found}; import navette.msgs.topics"
