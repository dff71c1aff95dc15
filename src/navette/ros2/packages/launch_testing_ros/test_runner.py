"""Runner of launch tests."""

from navette.ros2.packages.launch_testing.test_runner import LaunchTestRunner

__all__ = ["LaunchTestRunner"]
