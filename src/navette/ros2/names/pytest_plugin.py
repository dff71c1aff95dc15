"""``pytest -p navette.ros2.names.pytest_plugin`` runs tests of rclpy programs.

Where ROS 2 is installed, the tests run on ROS 2.
"""

from navette.ros2.names.hook import install, installed_rclpy


def pytest_configure() -> None:
    """Install the hook before pytest imports the tests."""
    if installed_rclpy() is None:
        install()
