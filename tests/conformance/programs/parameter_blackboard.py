"""A node that takes any parameter."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def main(args=None):
    try:
        with rclpy.init(args=args):
            rclpy.spin(Node("parameter_blackboard", allow_undeclared_parameters=True))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
