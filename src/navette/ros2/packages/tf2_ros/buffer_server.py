"""Answers for a buffer: the action that ``BufferClient`` asks.

In ROS 2 this is a program in C++, ``tf2_ros buffer_server``.
"""

from typing import Any

from navette.msgs.tf2_msgs.action import LookupTransform
from navette.ros2.packages.tf2_py import TransformException
from navette.ros2.packages.tf2_ros.lookup_errors import error_of
from navette.runtime import ActionServer, Buffer, Duration, Node, Time
from navette.runtime.callback_groups import ReentrantCallbackGroup


class BufferServer:
    """Serves the lookups of ``buffer`` as the action ``ns`` of a node.

    A question waits for its transform as long as it says; others are answered
    meanwhile.
    """

    def __init__(self, buffer: Buffer, node: Node, ns: str) -> None:
        self._buffer = buffer
        self._server = ActionServer(
            node,
            LookupTransform,
            ns,
            self._answer,
            callback_group=ReentrantCallbackGroup(),
        )

    def destroy(self) -> None:
        self._server.destroy()

    def _answer(self, goal: Any) -> Any:
        result = LookupTransform.Result()
        try:
            result.transform = self._look_up(goal.request)
        except TransformException as exception:
            result.error = error_of(exception)
            goal.abort()
        else:
            goal.succeed()
        return result

    def _look_up(self, wanted: Any) -> Any:
        timeout = Duration.from_msg(wanted.timeout)
        source_time = Time.from_msg(wanted.source_time)
        if not wanted.advanced:
            return self._buffer.lookup_transform(
                wanted.target_frame, wanted.source_frame, source_time, timeout
            )
        return self._buffer.lookup_transform_full(
            wanted.target_frame,
            Time.from_msg(wanted.target_time),
            wanted.source_frame,
            source_time,
            wanted.fixed_frame,
            timeout,
        )
