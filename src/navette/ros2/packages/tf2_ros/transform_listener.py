"""tf2_ros.transform_listener."""

from navette.runtime.tf import TransformListener

__all__ = ["TransformListener"]
