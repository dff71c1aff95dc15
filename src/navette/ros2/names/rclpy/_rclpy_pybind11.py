"""rclpy's inside, as far as programs use it: its errors, and a set to wait by."""

from navette.runtime.exceptions import InvalidHandle, RCLError
from navette.runtime.handles import PollSet as WaitSet

__all__ = [
    "InvalidHandle",
    "RCLError",
    "WaitSet",
]
