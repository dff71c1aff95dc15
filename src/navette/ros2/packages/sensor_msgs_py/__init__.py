"""sensor_msgs_py: conversion of point clouds to numpy arrays."""

from navette.ros2.packages.sensor_msgs_py import point_cloud2

__all__ = ["point_cloud2"]
