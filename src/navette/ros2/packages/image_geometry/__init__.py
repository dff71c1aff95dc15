"""image_geometry: pixels and points of cameras."""

from navette.ros2.packages.image_geometry.cameramodels import (
    PinholeCameraModel,
    StereoCameraModel,
)

__all__ = ["PinholeCameraModel", "StereoCameraModel"]
