"""tf2_ros.buffer_client: buffer that requests transforms from a buffer server."""

from typing import Any

from navette.msgs.builtin_interfaces.msg import Time as TimeMsg
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.tf2_msgs.action import LookupTransform
from navette.ros2.packages.tf2_ros.lookup_errors import exception_of
from navette.runtime import ActionClient, Duration, Future, Node, Time
from navette.runtime.tf import BufferInterface, TimeoutException, TransformException

_NO_WAIT = Duration()
_PADDING = Duration(seconds=2.0)


class BufferClient(BufferInterface):
    """Lookup of transforms by the action of a buffer server.

    Args:
        ns: name of the action.
        check_frequency: ignored, because the client does not poll.
        timeout_padding: time that is added to a lookup's timeout for the response.
    """

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = _PADDING,
    ) -> None:
        super().__init__()
        self.node = node
        self.action_client = ActionClient(node, LookupTransform, ns)
        self.check_frequency = check_frequency
        self.timeout_padding = timeout_padding

    def wait_for_server(self, timeout: Duration | None = None) -> bool:
        """Run events until the server is available; return False after the timeout."""
        seconds = None if timeout is None else timeout.nanoseconds / 1e9
        return self.action_client.wait_for_server(seconds)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMsg,
        timeout: Duration | None = _NO_WAIT,
    ) -> TransformStamped:
        """Return target_T_source at ``time``; run events until the response arrives.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException,
            InvalidArgumentException: the server's error.
            TimeoutException: the server does not exist or did not respond in time.
        """
        return self._request(
            timeout,
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=_time_message(time),
        )

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMsg,
        source_frame: str,
        source_time: Time | TimeMsg,
        fixed_frame: str,
        timeout: Duration | None = _NO_WAIT,
    ) -> TransformStamped:
        """As :meth:`lookup_transform`, through a frame that does not move."""
        return self._request(
            timeout,
            target_frame=target_frame,
            target_time=_time_message(target_time),
            source_frame=source_frame,
            source_time=_time_message(source_time),
            fixed_frame=fixed_frame,
            advanced=True,
        )

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMsg,
        timeout: Duration | None = _NO_WAIT,
    ) -> bool:
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMsg,
        source_frame: str,
        source_time: Time | TimeMsg,
        fixed_frame: str,
        timeout: Duration | None = _NO_WAIT,
    ) -> bool:
        query = (target_frame, target_time, source_frame, source_time, fixed_frame)
        try:
            self.lookup_transform_full(*query, timeout)
        except TransformException:
            return False
        return True

    def destroy(self) -> None:
        self.action_client.destroy()

    def _request(self, timeout: Duration | None, **goal: Any) -> TransformStamped:
        if not self.action_client.server_is_ready():
            raise TimeoutException(
                f"no buffer server for {self.action_client.action_name}"
            )
        timeout = timeout or _NO_WAIT
        loop = self.node.context.loop
        padded_ns = timeout.nanoseconds + self.timeout_padding.nanoseconds
        until_ns = loop.clock.now_ns + padded_ns
        handle = self._await(
            self.action_client.send_goal_async(
                LookupTransform.Goal(timeout=timeout.to_msg(), **goal)
            ),
            until_ns,
        )
        if not handle.accepted:
            raise TimeoutException("the buffer server rejected the request")
        result = self._await(handle.get_result_async(), until_ns).result
        if result.error.error != result.error.NO_ERROR:
            raise exception_of(result.error)
        transform: TransformStamped = result.transform
        return transform

    def _await(self, future: Future[Any], until_ns: int) -> Any:
        loop = self.node.context.loop
        loop.run(until_ns=until_ns, done=future.done, calling=True)
        if not future.done():
            raise TimeoutException("the buffer server did not respond in time")
        return future.result()


def _time_message(time: Time | TimeMsg) -> TimeMsg:
    if isinstance(time, TimeMsg):
        return time
    if not isinstance(time, Time):
        raise TypeError(f"expected a Time, got {time!r}")
    return time.to_msg()
