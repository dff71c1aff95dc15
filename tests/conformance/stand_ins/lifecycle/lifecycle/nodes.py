"""Nodes of ROS 2's C++ package ``lifecycle``; the suite of launch_ros starts them."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import Node


def _spin(name: str) -> None:
    rclpy.init()
    try:
        rclpy.spin(Node(name))
    except (KeyboardInterrupt, ExternalShutdownException):
        return


def listener() -> None:
    _spin("lc_listener")


def talker() -> None:
    _spin("lc_talker")
