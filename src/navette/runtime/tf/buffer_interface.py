"""Interface of buffers, with local or remote transforms."""

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
    """Base of buffers: transforms stamped objects with the lookups of a subclass."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration | None = NO_WAIT,
        new_type: Any = None,
    ) -> Any:
        """Transform an object to another frame at the time of its stamp.

        Raises:
            TypeException: no function is registered for the object's type.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transformed = do_transform(
            object_stamped,
            self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout),
        )
        return transformed if new_type is None else convert(transformed, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration | None = NO_WAIT,
        new_type: Any = None,
    ) -> Any:
        """As :meth:`transform`, with another time for the target.

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
        transformed = do_transform(object_stamped, found)
        return transformed if new_type is None else convert(transformed, new_type)

    # Subclasses override the following methods; :class:`Buffer` lists the arguments.

    def lookup_transform(self, *args: Any, **kwargs: Any) -> TransformStamped:
        raise NotImplementedException

    def lookup_transform_full(self, *args: Any, **kwargs: Any) -> TransformStamped:
        raise NotImplementedException

    def can_transform(self, *args: Any, **kwargs: Any) -> Any:
        raise NotImplementedException

    def can_transform_full(self, *args: Any, **kwargs: Any) -> Any:
        raise NotImplementedException
