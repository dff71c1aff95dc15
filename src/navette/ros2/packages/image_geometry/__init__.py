"""image_geometry: camera models for pixels and points."""

from navette.ros2.packages.image_geometry.cameramodels import (
    PinholeCameraModel,
    StereoCameraModel,
)
