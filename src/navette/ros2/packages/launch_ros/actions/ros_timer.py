"""A timer that runs on ROS time, which a simulation may set."""

from collections.abc import Callable

from navette.ros2.packages.launch.actions import TimerAction
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch_ros.ros_node import launch_node


class RosTimer(TimerAction):
    """As TimerAction, ``period`` seconds of ROS time after it is reached."""

    def schedule(
        self, context: LaunchContext, seconds: float, fire: Callable[[], None]
    ) -> None:
        launch_node(context).after(seconds, fire)
