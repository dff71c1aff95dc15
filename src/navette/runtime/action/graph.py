"""Graph queries for actions."""

from navette.runtime.graph_queries import NamesAndTypes
from navette.runtime.node import Node

_TOPIC = "/_action/feedback"
_TYPE = "_FeedbackMessage"


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """Return all actions that have a server or a client."""
    return _actions(node.get_topic_names_and_types())


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node serves."""
    return _actions(
        node.get_publisher_names_and_types_by_node(
            remote_node_name, remote_node_namespace
        )
    )


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node is a client of."""
    return _actions(
        node.get_subscriber_names_and_types_by_node(
            remote_node_name, remote_node_namespace
        )
    )


def _actions(topics: NamesAndTypes) -> NamesAndTypes:
    """Select the feedback topics and return their action names and types."""
    return [
        (topic.removesuffix(_TOPIC), [name.removesuffix(_TYPE) for name in types])
        for topic, types in topics
        if topic.endswith(_TOPIC)
    ]
