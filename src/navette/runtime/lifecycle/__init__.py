"""Managed nodes: configured, activated, deactivated and cleaned up on request.

As in rclpy, ``Node``, ``NodeMixin``, ``Publisher`` and ``State`` are short names.
"""

from navette.runtime.lifecycle.managed_entity import ManagedEntity, SimpleManagedEntity
from navette.runtime.lifecycle.node import LifecycleNode, LifecycleNodeMixin
from navette.runtime.lifecycle.publisher import LifecyclePublisher
from navette.runtime.lifecycle.state_machine import (
    LifecycleState,
    TransitionCallbackReturn,
)

Node = LifecycleNode
NodeMixin = LifecycleNodeMixin
Publisher = LifecyclePublisher
State = LifecycleState

__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "Node",
    "NodeMixin",
    "Publisher",
    "SimpleManagedEntity",
    "State",
    "TransitionCallbackReturn",
]
