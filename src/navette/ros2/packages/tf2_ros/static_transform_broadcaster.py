"""tf2_ros.static_transform_broadcaster."""

from navette.runtime.tf import StaticTransformBroadcaster

__all__ = ["StaticTransformBroadcaster"]
