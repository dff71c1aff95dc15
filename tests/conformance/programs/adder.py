"""A service that adds, and clients that call it in each of rclpy's ways."""

# ruff: noqa: T201 - what it prints is the test

import sys
import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import (
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node


class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request, response):
        self.get_logger().info(f"adding {request.a} and {request.b}")
        response.sum = request.a + request.b
        return response


class Caller(Node):
    """Calls from a timer, in a group of its own, and waits there."""

    def __init__(self):
        super().__init__("caller")
        self.client = self.create_client(
            AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup()
        )
        self.done = False
        self.create_timer(0.01, self.call)

    def call(self):
        if self.done or not self.client.service_is_ready():
            return
        print("blocking:", self.client.call(AddTwoInts.Request(a=5, b=6)).sum)
        self.done = True  # ends the program, whose main thread does not wait for this


def serve():
    with rclpy.init():
        node = Adder()
        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            print("the adder ends")


def call_and_spin():
    with rclpy.init():
        node = rclpy.create_node("caller")
        client = node.create_client(AddTwoInts, "add")
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info("waiting")
        future = client.call_async(AddTwoInts.Request(a=1, b=2))
        rclpy.spin_until_future_complete(node, future)
        print("future:", future.result().sum)


def call_in_coroutine():
    with rclpy.init():
        node = rclpy.create_node("caller")
        group = ReentrantCallbackGroup()
        client = node.create_client(AddTwoInts, "add", callback_group=group)
        client.wait_for_service()
        sums = []

        async def call():
            timer.cancel()
            response = await client.call_async(AddTwoInts.Request(a=3, b=4))
            sums.append(response.sum)

        timer = node.create_timer(0.01, call, callback_group=group)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        while rclpy.ok() and not sums:
            executor.spin_once(timeout_sec=1.0)
        print("coroutine:", sums[0])


def call_from_callback():
    with rclpy.init():
        node = Caller()
        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(node)
        while rclpy.ok() and not node.done:
            executor.spin_once(timeout_sec=1.0)


def call_beside_a_spinning_thread():
    with rclpy.init():
        node = rclpy.create_node("caller")
        client = node.create_client(AddTwoInts, "add")
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        client.wait_for_service()
        print("thread:", client.call(AddTwoInts.Request(a=7, b=8)).sum)
        executor.shutdown()
        thread.join()


if __name__ == "__main__":
    {
        "serve": serve,
        "future": call_and_spin,
        "coroutine": call_in_coroutine,
        "callback": call_from_callback,
        "thread": call_beside_a_spinning_thread,
    }[sys.argv[1]]()
