"""A managed talker, and a program that takes it through its states."""

# ruff: noqa: T201 - what it prints is the test

import sys

import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import Node, State, TransitionCallbackReturn
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = None

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self.publisher = self.create_lifecycle_publisher(String, "chatter", 10)
        self.timer = self.create_timer(0.02, self.talk)
        self.get_logger().info(f"configured, was {state.label}")
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        self.destroy_timer(self.timer)
        self.destroy_publisher(self.publisher)
        self.get_logger().info("cleaned up")
        return TransitionCallbackReturn.SUCCESS

    def talk(self):
        self.publisher.publish(String(data=f"active {self.publisher.is_activated}"))


def drive():
    node = rclpy.create_node("driver")
    change = node.create_client(ChangeState, "talker/change_state")
    look = node.create_client(GetState, "talker/get_state")
    change.wait_for_service()
    look.wait_for_service()
    received = []
    node.create_subscription(
        String, "chatter", lambda msg: received.append(msg.data), 10
    )

    def go(transition):
        request = ChangeState.Request(transition=Transition(id=transition))
        future = change.call_async(request)
        rclpy.spin_until_future_complete(node, future)
        state = look.call_async(GetState.Request())
        rclpy.spin_until_future_complete(node, state)
        print(future.result().success, state.result().current_state.label)

    go(Transition.TRANSITION_CONFIGURE)
    go(Transition.TRANSITION_ACTIVATE)
    while not received:
        rclpy.spin_once(node)
    print(received[0])
    go(Transition.TRANSITION_DEACTIVATE)
    go(Transition.TRANSITION_CLEANUP)


if __name__ == "__main__":
    rclpy.init()
    try:
        if sys.argv[1] == "talk":
            rclpy.spin(Talker())
        else:
            drive()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
