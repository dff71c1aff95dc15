"""tf2_ros.buffer_client: a buffer that asks a server elsewhere (see buffer_server)."""

from typing import Any

from navette.msgs.builtin_interfaces.msg import Duration as DurationMsg
from navette.msgs.builtin_interfaces.msg import Time as TimeMsg
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.tf2_msgs.action import LookupTransform
from navette.ros2.packages.tf2_py import TimeoutException, TransformException
from navette.ros2.packages.tf2_ros.lookup_errors import exception_of
from navette.runtime import ActionClient, Duration, Future, Node, Time
from navette.runtime.tf import BufferInterface

_NO_WAIT = Duration()
_PADDING = Duration(seconds=2.0)


class BufferClient(BufferInterface):
    """Looks transforms up by the action of a buffer server.

    Args:
        ns: the action's name.
        check_frequency: accepted as in ROS 2; nothing is polled here.
        timeout_padding: how much longer than a lookup's own timeout to wait for the
            server's answer.
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
        """Let events run until the server is there; False after the timeout."""
        seconds = None if timeout is None else timeout.nanoseconds / 1e9
        return self.action_client.wait_for_server(seconds)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMsg,
        timeout: Duration | None = _NO_WAIT,
    ) -> TransformStamped:
        """target_T_source at ``time``; events run while the server looks.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException,
            InvalidArgumentException: what the server met.
            TimeoutException: it did not answer, or there is none.
        """
        return self._ask(
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
        """Through a frame that does not move between the two times; raises as above."""
        return self._ask(
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
        """Whether :meth:`lookup_transform` gives an answer."""
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
        """Whether :meth:`lookup_transform_full` gives an answer."""
        ask = (target_frame, target_time, source_frame, source_time, fixed_frame)
        try:
            self.lookup_transform_full(*ask, timeout)
        except TransformException:
            return False
        return True

    def destroy(self) -> None:
        self.action_client.destroy()

    # -- inside ----------------------------------------------------------------

    def _ask(self, timeout: Duration | None, **goal: Any) -> TransformStamped:
        if not self.action_client.server_is_ready():
            raise TimeoutException(
                f"no buffer server serves {self.action_client.action_name}"
            )
        timeout = timeout or _NO_WAIT
        wanted: DurationMsg = timeout.to_msg()
        loop = self.node.context.loop
        padded_ns = timeout.nanoseconds + self.timeout_padding.nanoseconds
        until_ns = loop.clock.now_ns + padded_ns
        handle = self._await(
            self.action_client.send_goal_async(
                LookupTransform.Goal(timeout=wanted, **goal)
            ),
            until_ns,
        )
        if not handle.accepted:
            raise TimeoutException("the buffer server refused the question")
        result = self._await(handle.get_result_async(), until_ns).result
        if result.error.error != result.error.NO_ERROR:
            raise exception_of(result.error)
        transform: TransformStamped = result.transform
        return transform

    def _await(self, future: Future[Any], until_ns: int) -> Any:
        loop = self.node.context.loop
        loop.run(until_ns=until_ns, done=future.done, calling=True)
        if not future.done():
            raise TimeoutException("the buffer server did not answer in time")
        return future.result()


def _time_message(time: Time | TimeMsg) -> TimeMsg:
    if isinstance(time, TimeMsg):
        return time
    if not isinstance(time, Time):
        raise TypeError(f"wanted a Time, got {time!r}")
    return time.to_msg()
