"""cv_bridge: conversion between image messages and OpenCV images."""

from navette.ros2.packages.cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]
