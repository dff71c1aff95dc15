"""An action that counts Fibonacci's numbers, slowly; asked for, and cancelled."""

# ruff: noqa: T201 - what it prints is the test

import sys
import time

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Server(Node):
    def __init__(self):
        super().__init__("server")
        self.server = ActionServer(
            self,
            Fibonacci,
            "count",
            execute_callback=self.execute,
            goal_callback=self.accept,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def accept(self, goal):
        return GoalResponse.ACCEPT if goal.order < 50 else GoalResponse.REJECT

    def execute(self, goal_handle):
        numbers = [0, 1]
        while len(numbers) <= goal_handle.request.order:
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.get_logger().info("cancelled")
                return Fibonacci.Result(sequence=numbers)
            numbers.append(numbers[-1] + numbers[-2])
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            time.sleep(0.02)  # noqa: TID251  # as ROS 2 programs do
        goal_handle.succeed()
        return Fibonacci.Result(sequence=numbers)


class Client(Node):
    def __init__(self, order, cancel_after):
        super().__init__("client")
        self.client = ActionClient(self, Fibonacci, "count")
        self.client.wait_for_server()
        self.cancel_after = cancel_after
        self.seen = 0
        self.client.send_goal_async(
            Fibonacci.Goal(order=order), feedback_callback=self.feedback
        ).add_done_callback(self.answered)

    def answered(self, future):
        self.goal = future.result()
        print("accepted", self.goal.accepted)
        if not self.goal.accepted:
            rclpy.shutdown()
            return
        self.goal.get_result_async().add_done_callback(self.ended)

    def feedback(self, msg):
        self.seen += 1
        print("feedback", msg.feedback.sequence.tolist())
        if self.seen == self.cancel_after:
            self.goal.cancel_goal_async()

    def ended(self, future):
        words = {
            GoalStatus.STATUS_SUCCEEDED: "succeeded",
            GoalStatus.STATUS_CANCELED: "canceled",
        }
        print(words[future.result().status], future.result().result.sequence.tolist())
        rclpy.shutdown()


def serve():
    node = Server()
    executor = MultiThreadedExecutor()
    rclpy.spin(node, executor)


if __name__ == "__main__":
    rclpy.init()
    try:
        if sys.argv[1] == "serve":
            serve()
        else:
            rclpy.spin(Client(int(sys.argv[1]), int(sys.argv[2])))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
