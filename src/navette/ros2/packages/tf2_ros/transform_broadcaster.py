"""tf2_ros.transform_broadcaster."""

from navette.runtime.tf import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
