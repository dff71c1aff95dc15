"""A timer that runs on ROS time, which a simulation may set."""

from typing import TYPE_CHECKING

from navette.ros2.packages.launch.actions import TimerAction
from navette.ros2.packages.launch_ros.ros_node import launch_node

if TYPE_CHECKING:
    from collections.abc import Callable

    from navette.ros2.packages.launch import LaunchContext


class RosTimer(TimerAction):
    """As TimerAction, ``period`` seconds of ROS time after it is reached."""

    def schedule(
        self, context: "LaunchContext", seconds: float, fire: "Callable[[], None]"
    ) -> None:
        launch_node(context).after(seconds, fire)
