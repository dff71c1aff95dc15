"""Wait for one message."""

from navette.runtime import Node, QoSProfile
from navette.runtime.signals import SignalHandlerGuardCondition
from navette.runtime.wait_for_message import wait_for_message

__all__ = [
    "Node",
    "QoSProfile",
    "SignalHandlerGuardCondition",
    "wait_for_message",
]
