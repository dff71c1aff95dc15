"""Clients of actions."""

from navette.runtime import Future, QoSProfile
from navette.runtime.action.client import ActionClient, ClientGoalHandle
from navette.runtime.executor import await_or_execute
from navette.runtime.qos import (
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from navette.runtime.type_support import check_for_type_support
from navette.runtime.wait_set import NumberOfEntities
from navette.runtime.waitable import Waitable

__all__ = [
    "ActionClient",
    "ClientGoalHandle",
    "Future",
    "NumberOfEntities",
    "QoSProfile",
    "Waitable",
    "await_or_execute",
    "check_for_type_support",
    "qos_profile_action_status_default",
    "qos_profile_services_default",
]
