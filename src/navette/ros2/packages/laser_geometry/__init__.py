"""laser_geometry: conversion of scans to point clouds."""

from navette.ros2.packages.laser_geometry.laser_geometry import LaserProjection

__all__ = ["LaserProjection"]
