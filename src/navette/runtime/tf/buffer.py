"""tf2's Buffer: transforms as messages, waiting and awaiting for them."""

from collections.abc import Callable
from typing import Any

from navette.geometry import Transform3
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.runtime.future import Future
from navette.runtime.ros_clock import JumpThreshold, TimeJump
from navette.runtime.tf.buffer_core import BufferCore
from navette.runtime.tf.conversions import transform_from_msg, transform_stamped
from navette.runtime.tf.do_transform import do_transform
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.time import Duration, Time, stamp_to_ns

_DEFAULT_CACHE = Duration(seconds=10)


class Buffer:
    """Keeps transforms for ``cache_time`` and answers questions about them.

    Times may be a :class:`Time`, a stamp message or integer nanoseconds; zero means
    the newest time at which the whole chain is known.

    Args:
        cache_time: how long moving transforms are kept.
        node: its clock tells of jumps back in time, which clear moving transforms;
            waits (``timeout``) need it.
    """

    def __init__(self, cache_time: Duration | None = None, node: Any = None) -> None:
        self.core = BufferCore((cache_time or _DEFAULT_CACHE).nanoseconds)
        self._node = node
        self._waiting: list[tuple[Callable[[], bool], Future[bool]]] = []
        if node is not None:
            threshold = JumpThreshold(
                min_forward=None, min_backward=Duration(nanoseconds=-1)
            )
            node.get_clock().create_jump_callback(
                threshold, post_callback=self._on_jump
            )

    # -- filling ---------------------------------------------------------------

    def set_transform(self, transform: TransformStamped, authority: str = "") -> None:
        """Take over a moving transform."""
        self._set(transform, is_static=False)

    def set_transform_static(
        self, transform: TransformStamped, authority: str = ""
    ) -> None:
        """Take over a transform that holds for all times."""
        self._set(transform, is_static=True)

    def clear(self) -> None:
        """Forget everything."""
        self.core.clear()

    # -- asking ----------------------------------------------------------------

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = None,
    ) -> TransformStamped:
        """target_T_source at ``time``; waits up to ``timeout`` while events run.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException
        """
        self._wait(target_frame, source_frame, time, timeout)
        target_T_source, stamp_ns = self.core.lookup(
            target_frame, source_frame, _nanoseconds(time)
        )
        return transform_stamped(target_frame, source_frame, stamp_ns, target_T_source)

    def lookup(self, target_frame: str, source_frame: str, stamp_ns: int) -> Transform3:
        """As :meth:`lookup_transform`, without messages: target_T_source."""
        return self.core.lookup(target_frame, source_frame, stamp_ns)[0]

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = None,
    ) -> TransformStamped:
        """Where the source was at its time, seen from the target at its own time.

        ``fixed_frame`` does not move between the two times.
        """
        self._wait(target_frame, fixed_frame, target_time, timeout)
        self._wait(fixed_frame, source_frame, source_time, timeout)
        target_T_fixed, stamp_ns = self.core.lookup(
            target_frame, fixed_frame, _nanoseconds(target_time)
        )
        fixed_T_source, _ = self.core.lookup(
            fixed_frame, source_frame, _nanoseconds(source_time)
        )
        return transform_stamped(
            target_frame, source_frame, stamp_ns, target_T_fixed @ fixed_T_source
        )

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration | None = None
    ) -> Any:
        """A PointStamped, PoseStamped or Vector3Stamped in another frame."""
        header = object_stamped.header
        transform = self.lookup_transform(
            target_frame, header.frame_id, header.stamp, timeout
        )
        return do_transform(object_stamped, transform)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = None,
    ) -> bool:
        """Whether :meth:`lookup_transform` would give an answer."""
        self._wait(target_frame, source_frame, time, timeout)
        return self._is_known(target_frame, source_frame, _nanoseconds(time))

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """The newest time at which the chain between the frames is known."""
        return Time(nanoseconds=self.core.newest_common_ns(target_frame, source_frame))

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> TransformStamped:
        """Await the transform, however long it takes."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform(target_frame, source_frame, time)

    def wait_for_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> Future[bool]:
        """A future that is done once the transform is known."""
        stamp_ns = _nanoseconds(time)

        def is_known() -> bool:
            return self._is_known(target_frame, source_frame, stamp_ns)

        loop = None if self._node is None else self._node.context.loop
        future: Future[bool] = Future(executor=loop)
        if is_known():
            future.set_result(True)
        else:
            self._waiting.append((is_known, future))
        return future

    def all_frames_as_yaml(self) -> str:
        """child: parent, span of time and number of samples, as tf2 prints it."""
        lines = []
        for child, history in sorted(self.core.histories().items()):
            lines.append(
                f"{child}:\n  parent: '{history.parent}'\n"
                f"  is_static: {str(history.is_static).lower()}\n"
                f"  most_recent_transform: {history.newest_ns / 1e9:.6f}\n"
                f"  oldest_transform: {history.oldest_ns / 1e9:.6f}"
            )
        return "\n".join(lines)

    # -- inside ----------------------------------------------------------------

    def _set(self, message: TransformStamped, *, is_static: bool) -> None:
        header = message.header
        self.core.set(
            header.frame_id,
            message.child_frame_id,
            stamp_to_ns(header.stamp),
            transform_from_msg(message.transform),
            is_static=is_static,
        )
        if self._waiting:
            self._release()

    def _release(self) -> None:
        waiting, self._waiting = self._waiting, []
        for entry in waiting:
            if entry[0]():
                entry[1].set_result(True)
            elif not entry[1].done():
                self._waiting.append(entry)

    def _is_known(self, target: str, source: str, stamp_ns: int) -> bool:
        try:
            self.core.lookup(target, source, stamp_ns)
        except TransformException:
            return False
        return True

    def _wait(
        self, target: str, source: str, time: Any, timeout: Duration | None
    ) -> None:
        if self._node is None or timeout is None or timeout.nanoseconds <= 0:
            return
        stamp_ns = _nanoseconds(time)
        if self._is_known(target, source, stamp_ns):
            return
        loop = self._node.context.loop
        loop.run(
            until_ns=loop.clock.now_ns + timeout.nanoseconds,
            done=lambda: self._is_known(target, source, stamp_ns),
        )

    def _on_jump(self, jump: TimeJump) -> None:
        self.core.drop_moving()


def _nanoseconds(time: Any) -> int:
    """Of a Time, a stamp message, or nanoseconds."""
    if isinstance(time, int):
        return time
    if isinstance(time, Time):
        return time.nanoseconds
    return stamp_to_ns(time)
