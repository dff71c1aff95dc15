"""Two nodes of other files in one executor."""

# ruff: noqa: T201 - what it prints is the test

import rclpy
from listener_node import Listener
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from talker import Talker


def main():
    rclpy.init()
    talker, listener = Talker(), Listener(MutuallyExclusiveCallbackGroup())
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(talker)
    executor.add_node(listener)
    try:
        executor.spin()
    except KeyboardInterrupt:
        print("interrupted, received", bool(listener.received))
    finally:
        executor.shutdown()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
