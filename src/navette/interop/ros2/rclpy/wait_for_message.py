"""Wait for one message."""

from navette.runtime.wait_for_message import wait_for_message

__all__ = ["wait_for_message"]
