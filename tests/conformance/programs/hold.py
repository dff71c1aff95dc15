"""Publishes a forward command at 10 Hz on a topic, as a held key does."""

import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

rclpy.init(args=sys.argv)
node = Node("hold")
publisher = node.create_publisher(Twist, sys.argv[1], 10)
command = Twist()
command.linear.x = float(sys.argv[2])
node.create_timer(0.1, lambda: publisher.publish(command))
rclpy.spin(node)
