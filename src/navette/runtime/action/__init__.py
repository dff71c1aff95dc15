"""Actions: long-running goals with feedback, cancelling and a result."""

from navette.runtime.action.client import ActionClient
from navette.runtime.action.goal_states import CancelResponse, GoalEvent, GoalResponse
from navette.runtime.action.graph import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from navette.runtime.action.server import ActionServer

__all__ = [
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]
