"""The former name of rclpy.event_handler."""

from navette.ros2.names.rclpy.event_handler import *  # noqa: F403 - all of it
from navette.ros2.names.rclpy.event_handler import __all__ as __all__
