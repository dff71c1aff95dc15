"""Timer on ROS time."""

from collections.abc import Callable

from navette.ros2.packages.launch.actions import TimerAction
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch_ros.ros_adapters import get_ros_adapter


class RosTimer(TimerAction):
    """TimerAction whose ``period`` is in seconds of ROS time."""

    def schedule(
        self, context: LaunchContext, seconds: float, fire: Callable[[], None]
    ) -> None:
        get_ros_adapter(context).after(seconds, fire)
