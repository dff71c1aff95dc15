"""The launch's own node: clients and subscriptions of actions, and ROS time."""

import os
import threading
from collections.abc import Callable, Sequence
from typing import Any

from navette.errors import CallbackError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.runtime import Context, Executor, Node, Parameter, SystemClock
from navette.runtime.graph import Graph

_NOTE = "ros adapter"
_RETRY_S = 0.05
_END_S = 5.0


class ROSAdapter:
    """A node on the graph of the launched nodes, with a thread of its own.

    Args:
        argv: arguments of the node's context.
        autostart: call :meth:`start`.
        launch: its loop runs the callbacks of :meth:`subscribe`, :meth:`call` and
            :meth:`after`.
        graph: that of the nodes in this process, if the launch has any.
    """

    def __init__(
        self,
        *,
        argv: Sequence[str] | None = None,
        autostart: bool = True,
        launch: LaunchContext | None = None,
        graph: Graph | None = None,
    ) -> None:
        self.argv = list(argv or ())
        self.ros_context: Context | None = None
        self._graph = graph
        self._launch = launch
        if autostart:
            self.start()

    def start(self) -> None:
        """Make the node and run its callbacks in a thread.

        Raises:
            RuntimeError: it runs already.
        """
        if self.ros_context is not None:
            raise RuntimeError("cannot start a ROS adapter that is already running")
        context = self.ros_context = Context(clock=SystemClock(), graph=self._graph)
        context.init(args=self.argv, initialize_logging=False)
        self.ros_node = Node(f"launch_ros_{os.getpid()}", context=context)
        self.ros_executor = Executor(context=context)
        self.ros_executor.add_node(self.ros_node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def shutdown(self) -> None:
        """Leave the graph.

        Raises:
            RuntimeError: it does not run.
        """
        if self.ros_context is None:
            raise RuntimeError("cannot shut down a ROS adapter that is not running")
        self.ros_context.try_shutdown()
        self._thread.join(_END_S)
        self.ros_context = None

    def set_use_sim_time(self, value: bool) -> None:
        """Run the node on the time of ``/clock``, or on that of the system."""
        parameter: Parameter[bool] = Parameter("use_sim_time", value=value)
        self._on_node_loop(lambda: self.ros_node.set_parameters([parameter]))

    def subscribe(
        self, message_type: Any, topic: str, callback: Callable[[Any], None]
    ) -> None:
        """Call ``callback`` on the launch's loop with every message."""

        def receive(message: Any) -> None:
            self._on_launch_loop(lambda: callback(message))

        self._on_node_loop(
            lambda: self.ros_node.create_subscription(message_type, topic, receive, 10)
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
            client = self.ros_node.create_client(service_type, name)

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

            timer = self.ros_node.create_timer(_RETRY_S, attempt)

        self._on_node_loop(begin)

    def after(self, seconds: float, function: Callable[[], None]) -> None:
        """Call ``function`` on the launch's loop after ``seconds`` of ROS time."""

        def begin() -> None:
            def fire() -> None:
                timer.cancel()
                self._on_launch_loop(function)

            timer = self.ros_node.create_timer(seconds, fire)

        self._on_node_loop(begin)

    def _spin(self) -> None:
        try:
            self.ros_executor.spin()
        except CallbackError as error:
            # Raised on the launch's loop, where it fails the launch.
            failure = error
            self._on_launch_loop(lambda: _raise(failure))

    def _on_node_loop(self, function: Callable[[], Any]) -> None:
        self.ros_executor.call_soon_threadsafe(function)

    def _on_launch_loop(self, function: Callable[[], None]) -> None:
        assert self._launch is not None, "callbacks belong to a launch"
        self._launch.loop.call_soon_threadsafe(function, "ros node")


def _raise(error: Exception) -> None:
    raise error


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the adapter of a launch; made on first use, shut down with the launch."""
    adapter: ROSAdapter | None = context.notes.get(_NOTE)
    if adapter is None:
        adapter = ROSAdapter(launch=context, graph=context.runner.graph)
        context.notes[_NOTE] = adapter
        context.on_close(adapter.shutdown)
    return adapter


def get_ros_node(context: LaunchContext) -> Node:
    """Return the node of a launch."""
    return get_ros_adapter(context).ros_node
