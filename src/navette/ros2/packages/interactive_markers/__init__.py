"""ROS 2's ``interactive_markers``: markers that a user moves, turns and clicks."""

from navette.ros2.packages.interactive_markers.interactive_marker_server import (
    InteractiveMarkerServer,
)
from navette.ros2.packages.interactive_markers.menu_handler import MenuHandler

__all__ = ["InteractiveMarkerServer", "MenuHandler"]
