"""Corners of rclpy's surface, each in a few lines, as programs for ROS 2 use them."""

# ruff: noqa: T201 - what it prints is the test

import asyncio
from concurrent.futures import ThreadPoolExecutor

import rclpy
import rclpy.logging
from example_interfaces.srv import AddTwoInts
from rclpy.exceptions import NotInitializedException
from rclpy.executors import Executor, TimeoutException
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription_content_filter_options import ContentFilterOptions
from std_msgs.msg import Int32, Int32MultiArray


def sequences():
    numbers = Int32MultiArray(data=[0, 1])
    numbers.data.append(numbers.data[0] + numbers.data[1])
    print("sequence", numbers.data, numbers.data[-1], bool(Int32MultiArray().data))
    print(numbers)


def filters(node):
    received = []
    publisher = node.create_publisher(Int32, "numbers", 10)
    node.create_subscription(
        Int32,
        "numbers",
        lambda message: received.append(message.data),
        QoSProfile(depth=2),
        content_filter_options=ContentFilterOptions("data > %0", ["1"]),
    )
    for number in (0, 2, 1, 3):
        publisher.publish(Int32(data=number))
    for _ in range(2):
        rclpy.spin_once(node, timeout_sec=1.0)
    print("filtered", received)


def errors(node):
    def fail():
        timer.cancel()
        raise KeyError("of the callback")

    timer = node.create_timer(0.01, fail)
    try:
        rclpy.spin(node)
    except KeyError as error:
        print("caught", type(error.__cause__).__name__, error.__cause__)
    node.destroy_timer(timer)


class PoolExecutor(Executor):
    """Each callback in a thread of a pool, as in the examples of ROS 2."""

    def __init__(self):
        super().__init__()
        self.pool = ThreadPoolExecutor(max_workers=2)

    def spin_once(self, timeout_sec=None):
        try:
            handler, _, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except TimeoutException:
            return
        self.pool.submit(handler).result()
        print("ran for", node.get_name())


def pooled():
    executor = PoolExecutor()
    node = Node("pooled")
    executor.add_node(node)
    node.create_timer(0.01, lambda: None)
    executor.spin_once(timeout_sec=1.0)
    executor.shutdown()
    node.destroy_node()


async def with_asyncio(node):
    node.create_service(
        AddTwoInts, "add", lambda q, r: AddTwoInts.Response(sum=q.a + q.b)
    )
    client = node.create_client(AddTwoInts, "add")
    future = client.call_async(AddTwoInts.Request(a=3, b=4))

    async def spin():
        while not future.done():
            rclpy.spin_once(node, timeout_sec=0.01)
            await asyncio.sleep(0)  # as ROS 2 programs do
        rclpy.spin_once(node, timeout_sec=0.01)

    spinning = asyncio.ensure_future(spin())
    response = await future
    await spinning
    print("asyncio", response.sum)


def main():
    rclpy.logging.get_logger("surface").info("before init")
    sequences()
    rclpy.init()
    node = rclpy.create_node("surface")
    filters(node)
    errors(node)
    pooled()
    asyncio.run(with_asyncio(node))
    rclpy.shutdown()
    try:
        rclpy.create_node("late")
    except NotInitializedException:
        print("no node without init")


if __name__ == "__main__":
    main()
