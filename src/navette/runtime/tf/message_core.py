"""tf2_py's BufferCore: transforms as messages, without waiting."""

from typing import Any

from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.runtime.tf.buffer_core import BufferCore, frame_name
from navette.runtime.tf.conversions import transform_from_msg, transform_stamped
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.tf.frame_history import FrameHistory
from navette.runtime.time import NS_PER_S, Duration, Time, stamp_to_ns

_DEFAULT_CACHE = Duration(seconds=10)
_SHORTEST_SPAN_S = 1e-4  # a single sample counts as this long for the rate


class MessageCore:
    """Buffer of the transforms of the last ``cache_time``.

    A time may be a :class:`Time`, a stamp message or integer nanoseconds; zero stands
    for the newest time at which all transforms of a chain are known.
    """

    def __init__(self, cache_time: Duration | None = None) -> None:
        self.core = BufferCore((cache_time or _DEFAULT_CACHE).nanoseconds)
        self._authorities: dict[str, str] = {}

    def set_transform(self, transform: TransformStamped, authority: str = "") -> None:
        """Add a moving transform; ``authority`` is the name of its publisher."""
        self._set(transform, authority, is_static=False)

    def set_transform_static(
        self, transform: TransformStamped, authority: str = ""
    ) -> None:
        self._set(transform, authority, is_static=True)

    def clear(self) -> None:
        self.core.drop_moving()

    def lookup_transform_core(
        self, target_frame: str, source_frame: str, time: Any
    ) -> TransformStamped:
        """Return target_T_source at ``time``.

        Raises:
            LookupException: a frame is unknown.
            ConnectivityException: the frames are not connected.
            ExtrapolationException: no data at the time.
        """
        target_T_source, stamp_ns = self.core.lookup(
            target_frame, source_frame, nanoseconds(time)
        )
        return transform_stamped(target_frame, source_frame, stamp_ns, target_T_source)

    def lookup_transform_full_core(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> TransformStamped:
        """Return target_T_source with different times for target and source."""
        target_T_fixed, stamp_ns = self.core.lookup(
            target_frame, fixed_frame, nanoseconds(target_time)
        )
        fixed_T_source, _ = self.core.lookup(
            fixed_frame, source_frame, nanoseconds(source_time)
        )
        return transform_stamped(
            target_frame, source_frame, stamp_ns, target_T_fixed @ fixed_T_source
        )

    def can_transform_core(
        self, target_frame: str, source_frame: str, time: Any
    ) -> tuple[bool, str]:
        """Return whether the lookup succeeds, and the reason if it does not."""
        try:
            self.core.lookup(target_frame, source_frame, nanoseconds(time))
        except TransformException as error:
            return False, str(error)
        return True, ""

    def can_transform_full_core(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> tuple[bool, str]:
        """As :meth:`can_transform_core`, through ``fixed_frame``."""
        known, reason = self.can_transform_core(target_frame, fixed_frame, target_time)
        if not known:
            return known, reason
        return self.can_transform_core(fixed_frame, source_frame, source_time)

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the newest time at which the chain between the frames is known."""
        return Time(nanoseconds=self.core.newest_common_ns(target_frame, source_frame))

    def all_frames_as_yaml(self) -> str:
        """Return parent, publisher, rate (Hz) and times (s) of each frame as YAML."""
        histories = sorted(self.core.histories().items())
        return "\n".join(self._yaml_of(*each) for each in histories) or "[]"

    def all_frames_as_string(self) -> str:
        """Return one line for each frame with a parent."""
        return "".join(
            f"Frame {child} exists with parent {history.parent}.\n"
            for child, history in sorted(self.core.histories().items())
        )

    def _frameExists(self, frame_id: str) -> bool:  # noqa: N802 - tf2's name
        return self.core.contains(frame_name(frame_id))

    def _getFrameStrings(self) -> list[str]:  # noqa: N802 - tf2's name
        return self.core.frames()

    def _yaml_of(self, child: str, history: FrameHistory) -> str:
        newest_s = history.newest_ns / NS_PER_S
        oldest_s = history.oldest_ns / NS_PER_S
        span_s = newest_s - oldest_s
        rate = history.count / max(span_s, _SHORTEST_SPAN_S)
        authority = self._authorities.get(child) or "no recorded authority"
        return (
            f"{child}: \n"
            f"  parent: '{history.parent}'\n"
            f"  broadcaster: '{authority}'\n"
            f"  rate: {rate:.3f}\n"
            f"  most_recent_transform: {newest_s:.6f}\n"
            f"  oldest_transform: {oldest_s:.6f}\n"
            f"  buffer_length: {span_s:.3f}"
        )

    def _set(
        self, message: TransformStamped, authority: str, *, is_static: bool
    ) -> None:
        header = message.header
        child = message.child_frame_id
        self.core.set(
            header.frame_id,
            child,
            stamp_to_ns(header.stamp),
            transform_from_msg(message.transform),
            is_static=is_static,
        )
        if authority:
            self._authorities[child] = authority


def nanoseconds(time: Any) -> int:
    """Return the nanoseconds of a Time, a stamp message or an int.

    Raises:
        TypeError: the argument is something else.
    """
    if isinstance(time, int):
        return time
    if isinstance(time, Time):
        return time.nanoseconds
    if hasattr(time, "sec") and hasattr(time, "nanosec"):
        return stamp_to_ns(time)
    if hasattr(time, "nanoseconds"):
        return int(time.nanoseconds)
    raise TypeError(
        f"expected a rclpy.time.Time or a builtin_interfaces/msg/Time, got {time!r}"
    )
