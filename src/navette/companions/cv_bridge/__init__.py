"""cv_bridge: image messages and OpenCV's images."""

from navette.companions.cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]
