"""Publishes on /chatter; with --ros-args -p count:=N it stops after N messages."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.left = self.declare_parameter("count", 0).value
        period = self.declare_parameter("period", 0.02).value
        self.number = 0
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.timer = self.create_timer(period, self.talk)

    def talk(self):
        msg = String()
        msg.data = f"message {self.number}"
        self.number += 1
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.publisher.publish(msg)
        if self.number == self.left:
            raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    node = Talker()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
