"""The launch's own node: requests and observes transitions, and runs ROS timers."""

import os
import threading
from collections.abc import Callable
from typing import Any

from navette.errors import CallbackError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.runtime import Context, Executor, Node, SystemClock

_NOTE = "ros node"
_RETRY_S = 0.05
_END_S = 5.0


class LaunchNode:
    """A node on the graph of the launched nodes, with a thread of its own.

    Args:
        launch: its loop runs the callbacks.
    """

    def __init__(self, launch: LaunchContext) -> None:
        self._launch = launch
        self._context = Context(clock=SystemClock(), graph=launch.runner.graph)
        self._context.init(args=[], initialize_logging=False)
        self._node = Node(f"launch_ros_{os.getpid()}", context=self._context)
        self._executor = Executor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def subscribe(
        self, message_type: Any, topic: str, callback: Callable[[Any], None]
    ) -> None:
        """Call ``callback`` on the launch's loop with every message."""

        def receive(message: Any) -> None:
            self._on_launch_loop(lambda: callback(message))

        self._on_node_loop(
            lambda: self._node.create_subscription(message_type, topic, receive, 10)
        )

    def call(
        self,
        service_type: Any,
        name: str,
        request: Any,
        on_response: Callable[[Any], None],
    ) -> None:
        """Call a service as soon as it is available.

        ``on_response`` runs on the launch's loop.
        """

        def begin() -> None:
            client = self._node.create_client(service_type, name)

            def attempt() -> None:
                if not client.service_is_ready():
                    return
                timer.cancel()
                future = client.call_async(request)
                future.add_done_callback(
                    lambda done: self._on_launch_loop(
                        lambda: on_response(done.result())
                    )
                )

            timer = self._node.create_timer(_RETRY_S, attempt)

        self._on_node_loop(begin)

    def after(self, seconds: float, function: Callable[[], None]) -> None:
        """Call ``function`` on the launch's loop after ``seconds`` of ROS time."""

        def begin() -> None:
            def fire() -> None:
                timer.cancel()
                self._on_launch_loop(function)

            timer = self._node.create_timer(seconds, fire)

        self._on_node_loop(begin)

    def close(self) -> None:
        """Leave the graph."""
        self._context.try_shutdown()
        self._thread.join(_END_S)

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except CallbackError as error:
            # Raised on the launch's loop, where it fails the launch.
            failure = error
            self._on_launch_loop(lambda: _raise(failure))

    def _on_node_loop(self, function: Callable[[], Any]) -> None:
        self._executor.call_soon_threadsafe(function)

    def _on_launch_loop(self, function: Callable[[], None]) -> None:
        self._launch.loop.call_soon_threadsafe(function, "ros node")


def _raise(error: Exception) -> None:
    raise error


def launch_node(context: LaunchContext) -> LaunchNode:
    """Return the node of a launch; created on first use, closed with the launch."""
    node: LaunchNode | None = context.notes.get(_NOTE)
    if node is None:
        node = context.notes[_NOTE] = LaunchNode(context)
        context.on_close(node.close)
    return node
