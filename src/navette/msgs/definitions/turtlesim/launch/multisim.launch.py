"""Two canvases with a turtle each, in namespaces of their own."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            Node(
                namespace=namespace,
                package="turtlesim",
                executable="turtlesim_node",
                output="screen",
            )
            for namespace in ("turtlesim1", "turtlesim2")
        ]
    )
