"""``pytest -p navette.ros2.names.pytest_plugin``: tests of rclpy programs run here.

Where ROS 2 is installed, the tests run on ROS 2.
"""

from navette.ros2.names.hook import install, installed_rclpy


def pytest_configure() -> None:
    """Called by pytest before it imports any test."""
    if installed_rclpy() is None:
        install()
