"""tf2's Buffer: lookup of transforms as messages, with waiting."""

from collections.abc import Callable
from typing import Any

from navette.geometry import Transform3
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.runtime.future import Future
from navette.runtime.ros_clock import JumpThreshold, TimeJump
from navette.runtime.tf.buffer_interface import NO_WAIT, BufferInterface
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.tf.message_core import MessageCore
from navette.runtime.time import Duration


class Buffer(MessageCore, BufferInterface):
    """Buffer of transforms.

    Args:
        cache_time: how long moving transforms are kept.
        node: serves ``tf2_frames`` (the tree as YAML). Its clock clears the moving
            transforms when it jumps backward; a ``timeout`` requires it. Without a node
            the buffer uses that of its first listener and has no service.
    """

    def __init__(self, cache_time: Duration | None = None, node: Any = None) -> None:
        MessageCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._node: Any = None
        self._waiting: list[tuple[Callable[[], bool], Future[Any]]] = []
        if node is not None:
            self.attach(node)
            service = "tf2_msgs/srv/FrameGraph"
            node._node_serve(service, "tf2_frames", self._serve_frames)

    def attach(self, node: Any) -> None:
        """Use the clock of this node unless the buffer has a node already."""
        if self._node is not None:
            return
        self._node = node
        threshold = JumpThreshold(
            min_forward=None, min_backward=Duration(nanoseconds=-1)
        )
        node.get_clock().create_jump_callback(
            threshold, post_callback=self.time_jump_callback
        )

    def time_jump_callback(self, time_jump: TimeJump) -> None:
        self.clear()

    def lookup(self, target_frame: str, source_frame: str, stamp_ns: int) -> Transform3:
        """Return target_T_source as :meth:`lookup_transform`, but not as a message."""
        return self.core.lookup(target_frame, source_frame, stamp_ns)[0]

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = NO_WAIT,
    ) -> TransformStamped:
        """Return target_T_source at ``time``; wait up to ``timeout`` and run events.

        Raises:
            LookupException: a frame is unknown.
            ConnectivityException: the frames are not connected.
            ExtrapolationException: no data at the time.
        """
        query = (target_frame, source_frame, time)
        self._wait(lambda: self.can_transform_core(*query)[0], timeout)
        return self.lookup_transform_core(*query)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
    ) -> TransformStamped:
        """Return target_T_source with different times for target and source.

        ``fixed_frame`` does not move between the two times.
        """
        query = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(lambda: self.can_transform_full_core(*query)[0], timeout)
        return self.lookup_transform_full_core(*query)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Whether :meth:`lookup_transform` succeeds.

        Return a bool, with ``return_debug_tuple`` a bool and the reason.
        """
        query = (target_frame, source_frame, time)
        self._wait(lambda: self.can_transform_core(*query)[0], timeout)
        result = self.can_transform_core(*query)
        return result if return_debug_tuple else result[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> Any:
        """As :meth:`can_transform`, through ``fixed_frame``."""
        query = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(lambda: self.can_transform_full_core(*query)[0], timeout)
        result = self.can_transform_full_core(*query)
        return result if return_debug_tuple else result[0]

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> TransformStamped:
        """Await the transform without a timeout."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> TransformStamped:
        """Await the transform through ``fixed_frame`` without a timeout."""
        query = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*query)
        return self.lookup_transform_full_core(*query)

    def wait_for_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> Future[TransformStamped]:
        """Return a future of the transform, done as soon as it is available."""
        query = (target_frame, source_frame, time)
        return self._future_of(lambda: self.lookup_transform_core(*query))

    def wait_for_transform_full_async(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> Future[TransformStamped]:
        """Return a future of the transform through ``fixed_frame``."""
        query = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._future_of(lambda: self.lookup_transform_full_core(*query))

    def _serve_frames(self, request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def _set(
        self, message: TransformStamped, authority: str, *, is_static: bool
    ) -> None:
        super()._set(message, authority, is_static=is_static)
        if self._waiting:
            self._complete_waiting()

    def _future_of(
        self, lookup: Callable[[], TransformStamped]
    ) -> Future[TransformStamped]:
        loop = None if self._node is None else self._node.context.loop
        future: Future[TransformStamped] = Future(executor=loop)

        def is_found() -> bool:
            try:
                future.set_result(lookup())
            except TransformException:
                return False
            return True

        if not is_found():
            self._waiting.append((is_found, future))
        return future

    def _complete_waiting(self) -> None:
        waiting, self._waiting = self._waiting, []
        for is_found, future in waiting:
            if not future.done() and not is_found():
                self._waiting.append((is_found, future))

    def _wait(self, is_known: Callable[[], bool], timeout: Duration | None) -> None:
        """Run events until the transform is known or ``timeout`` has passed."""
        if self._node is None or timeout is None or timeout.nanoseconds <= 0:
            return
        if is_known():
            return
        loop = self._node.context.loop
        loop.run(until_ns=loop.clock.now_ns + timeout.nanoseconds, done=is_known)
