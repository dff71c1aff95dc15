"""ROS 2's ``launch_testing_ros``: nodes beside the processes of a launch test."""

from navette.ros2.packages.launch_testing.test_runner import LaunchTestRunner
from navette.ros2.packages.launch_testing_ros import tools
from navette.ros2.packages.launch_testing_ros.data_republisher import DataRepublisher
from navette.ros2.packages.launch_testing_ros.message_pump import MessagePump
from navette.ros2.packages.launch_testing_ros.wait_for_topics import WaitForTopics

__all__ = [
    "DataRepublisher",
    "LaunchTestRunner",
    "MessagePump",
    "WaitForTopics",
    "tools",
]
