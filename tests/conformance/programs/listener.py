"""Prints messages of /chatter; without a class."""

# ruff: noqa: T201 - what it prints is the test

import sys

import rclpy
from rclpy.qos import qos_profile_sensor_data
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


def main():
    rclpy.init()
    wanted = int(remove_ros_args(sys.argv)[1])
    received = []
    node = rclpy.create_node("listener")
    node.create_subscription(
        String,
        "chatter",
        lambda msg: (received.append(msg.data), print("I heard:", msg.data)),
        qos_profile_sensor_data,
    )
    while rclpy.ok() and len(received) < wanted:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    rclpy.shutdown()
    return 0 if len(received) == wanted else 3


if __name__ == "__main__":
    sys.exit(main())
