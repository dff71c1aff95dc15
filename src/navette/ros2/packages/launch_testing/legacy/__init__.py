"""Tests of launches whose processes decide: by exit codes and by output."""

from navette.ros2.packages.launch_testing.legacy import output
from navette.ros2.packages.launch_testing.legacy.service import LaunchTestService

__all__ = ["LaunchTestService", "output"]
