"""cv_bridge: image messages and OpenCV's images."""

from navette.ros2.packages.cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]
