"""tf2's Buffer: transforms as messages, waiting and awaiting for them."""

from collections.abc import Callable
from typing import Any, Literal, overload

from navette.geometry import Transform3
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.runtime.future import Future
from navette.runtime.ros_clock import JumpThreshold, TimeJump
from navette.runtime.tf.buffer_interface import NO_WAIT, BufferInterface
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.tf.message_core import MessageCore
from navette.runtime.time import Duration

_Answer = bool | tuple[bool, str]


class Buffer(MessageCore, BufferInterface):
    """Keeps transforms for ``cache_time`` and answers questions about them.

    Args:
        cache_time: how long moving transforms are kept.
        node: its clock tells of jumps back in time, which clear moving transforms;
            waits (``timeout``) need it; it serves ``tf2_frames``, the tree as YAML. A
            buffer made without one takes that of the first listener that fills it (and
            serves nothing).
    """

    def __init__(self, cache_time: Duration | None = None, node: Any = None) -> None:
        MessageCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._node: Any = None
        self._waiting: list[tuple[Callable[[], bool], Future[Any]]] = []
        if node is not None:
            self.attach(node)
            node.serve("tf2_msgs/srv/FrameGraph", "tf2_frames", self._tell_frames)

    def attach(self, node: Any) -> None:
        """Wait by, and watch, this node's clock, if no other node came before."""
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
        """Time was set back: what moved after that is not true any more."""
        self.clear()

    # -- asking ----------------------------------------------------------------

    def lookup(self, target_frame: str, source_frame: str, stamp_ns: int) -> Transform3:
        """As :meth:`lookup_transform`, without messages: target_T_source."""
        return self.core.lookup(target_frame, source_frame, stamp_ns)[0]

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = NO_WAIT,
    ) -> TransformStamped:
        """target_T_source at ``time``; waits up to ``timeout`` while events run.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException
        """
        ask = (target_frame, source_frame, time)
        self._wait(lambda: self.can_transform_core(*ask)[0], timeout)
        return self.lookup_transform_core(*ask)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
    ) -> TransformStamped:
        """Where the source was at its time, seen from the target at its own time.

        ``fixed_frame`` does not move between the two times.
        """
        ask = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(lambda: self.can_transform_full_core(*ask)[0], timeout)
        return self.lookup_transform_full_core(*ask)

    @overload
    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = ...,
        return_debug_tuple: Literal[False] = ...,
    ) -> bool: ...
    @overload
    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = ...,
        *,
        return_debug_tuple: Literal[True],
    ) -> tuple[bool, str]: ...
    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> _Answer:
        """Whether :meth:`lookup_transform` would give an answer (and why not)."""
        ask = (target_frame, source_frame, time)
        self._wait(lambda: self.can_transform_core(*ask)[0], timeout)
        answer = self.can_transform_core(*ask)
        return answer if return_debug_tuple else answer[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> _Answer:
        """Whether :meth:`lookup_transform_full` would give one (and why not)."""
        ask = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(lambda: self.can_transform_full_core(*ask)[0], timeout)
        answer = self.can_transform_full_core(*ask)
        return answer if return_debug_tuple else answer[0]

    # -- awaiting --------------------------------------------------------------

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> TransformStamped:
        """Await the transform, however long it takes."""
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
        """Await the transform through ``fixed_frame``, however long it takes."""
        ask = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*ask)
        return self.lookup_transform_full_core(*ask)

    def wait_for_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> Future[TransformStamped]:
        """A future with the transform, done once it is known."""
        ask = (target_frame, source_frame, time)
        return self._future_of(lambda: self.lookup_transform_core(*ask))

    def wait_for_transform_full_async(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> Future[TransformStamped]:
        """A future with the transform through ``fixed_frame``."""
        ask = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._future_of(lambda: self.lookup_transform_full_core(*ask))

    # -- inside ----------------------------------------------------------------

    def _tell_frames(self, request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def _set(
        self, message: TransformStamped, authority: str, *, is_static: bool
    ) -> None:
        super()._set(message, authority, is_static=is_static)
        if self._waiting:
            self._release()

    def _future_of(
        self, look: Callable[[], TransformStamped]
    ) -> Future[TransformStamped]:
        loop = None if self._node is None else self._node.context.loop
        future: Future[TransformStamped] = Future(executor=loop)

        def is_found() -> bool:
            try:
                future.set_result(look())
            except TransformException:
                return False
            return True

        if not is_found():
            self._waiting.append((is_found, future))
        return future

    def _release(self) -> None:
        waiting, self._waiting = self._waiting, []
        for is_found, future in waiting:
            if not future.done() and not is_found():
                self._waiting.append((is_found, future))

    def _wait(self, is_known: Callable[[], bool], timeout: Duration | None) -> None:
        """Run events until it is known, at most for ``timeout`` of the loop's time."""
        if self._node is None or timeout is None or timeout.nanoseconds <= 0:
            return
        if is_known():
            return
        loop = self._node.context.loop
        loop.run(until_ns=loop.clock.now_ns + timeout.nanoseconds, done=is_known)
