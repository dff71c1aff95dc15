"""Which actions are there, and who serves or uses them."""

from navette.runtime.node import Node
from navette.runtime.node_graph import NamesAndTypes

_TOPIC = "/_action/feedback"
_TYPE = "_FeedbackMessage"


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """All actions with a server or a client."""
    return _actions(node.get_topic_names_and_types())


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node serves."""
    return _actions(
        node.get_publisher_names_and_types_by_node(
            remote_node_name, remote_node_namespace
        )
    )


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node is a client of."""
    return _actions(
        node.get_subscriber_names_and_types_by_node(
            remote_node_name, remote_node_namespace
        )
    )


def _actions(topics: NamesAndTypes) -> NamesAndTypes:
    """Every action has a feedback topic, of a type made from the action's."""
    return [
        (topic.removesuffix(_TOPIC), [name.removesuffix(_TYPE) for name in types])
        for topic, types in topics
        if topic.endswith(_TOPIC)
    ]
