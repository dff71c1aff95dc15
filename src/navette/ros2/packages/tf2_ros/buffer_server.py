"""Server of a buffer's lookups as the action that ``BufferClient`` uses.

In ROS 2 this is a C++ program, ``tf2_ros buffer_server``.
"""

from typing import Any

from navette.msgs.tf2_msgs.action import LookupTransform
from navette.ros2.packages.tf2_ros.lookup_errors import error_of
from navette.runtime import ActionServer, Buffer, Duration, Node, Time
from navette.runtime.callback_groups import ReentrantCallbackGroup
from navette.runtime.tf import TransformException


class BufferServer:
    """Action server ``ns`` of the lookups of ``buffer``.

    A request waits for its transform up to its timeout; other requests run meanwhile.
    """

    def __init__(self, buffer: Buffer, node: Node, ns: str) -> None:
        self._buffer = buffer
        self._server = ActionServer(
            node,
            LookupTransform,
            ns,
            self._execute,
            callback_group=ReentrantCallbackGroup(),
        )

    def destroy(self) -> None:
        self._server.destroy()

    def _execute(self, goal: Any) -> Any:
        result = LookupTransform.Result()
        try:
            result.transform = self._look_up(goal.request)
        except TransformException as exception:
            result.error = error_of(exception)
            goal.abort()
        else:
            goal.succeed()
        return result

    def _look_up(self, request: Any) -> Any:
        timeout = Duration.from_msg(request.timeout)
        source_time = Time.from_msg(request.source_time)
        if not request.advanced:
            return self._buffer.lookup_transform(
                request.target_frame, request.source_frame, source_time, timeout
            )
        return self._buffer.lookup_transform_full(
            request.target_frame,
            Time.from_msg(request.target_time),
            request.source_frame,
            source_time,
            request.fixed_frame,
            timeout,
        )
