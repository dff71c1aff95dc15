"""Counts matches of a publisher as a subscription comes and goes."""

# ruff: noqa: T201 - what it prints is the test

import rclpy
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("watcher")
seen = Future()


def matched(info):
    print(f"{info.current_count_change:+d}, now {info.current_count}")
    seen.set_result(True)


publisher = node.create_publisher(
    String, "chatter", 10, event_callbacks=PublisherEventCallbacks(matched=matched)
)
executor = SingleThreadedExecutor()
executor.add_node(node)
subscription = node.create_subscription(String, "chatter", print, 10)
executor.spin_until_future_complete(seen, 1.0)
seen = Future()
node.destroy_subscription(subscription)
executor.spin_until_future_complete(seen, 1.0)
rclpy.shutdown()
