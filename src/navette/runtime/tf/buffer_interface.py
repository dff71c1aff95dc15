"""What every buffer offers, whether it holds the transforms or asks for them."""

from typing import Any

from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.runtime.tf.registration import (
    NotImplementedException,
    TransformRegistration,
    convert,
)
from navette.runtime.time import Duration

NO_WAIT = Duration()


class BufferInterface:
    """Moves stamped objects to other frames by the lookups its subclasses give."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration | None = NO_WAIT,
        new_type: Any = None,
    ) -> Any:
        """The object in another frame, at the time of its own stamp.

        Raises:
            TypeException: no function is registered for its type.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        moved = do_transform(
            object_stamped,
            self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout),
        )
        return moved if new_type is None else convert(moved, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
        new_type: Any = None,
    ) -> Any:
        """As :meth:`transform`, seen from the target at another time.

        ``fixed_frame`` does not move between the two times.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform_full(
            target_frame,
            target_time,
            header.frame_id,
            header.stamp,
            fixed_frame,
            timeout,
        )
        moved = do_transform(object_stamped, found)
        return moved if new_type is None else convert(moved, new_type)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = NO_WAIT,
    ) -> TransformStamped:
        """target_T_source at ``time``."""
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
    ) -> TransformStamped:
        """Where the source was at its time, seen from the target at its own."""
        raise NotImplementedException

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = NO_WAIT,
    ) -> Any:
        """Whether :meth:`lookup_transform` would give an answer."""
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
    ) -> Any:
        """Whether :meth:`lookup_transform_full` would give an answer."""
        raise NotImplementedException
