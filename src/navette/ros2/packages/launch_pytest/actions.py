"""Actions of test descriptions."""

from navette.ros2.packages.launch_testing.actions import ReadyToTest

__all__ = ["ReadyToTest"]
