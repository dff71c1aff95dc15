"""ROS 2's module names for Navette's modules: unmodified rclpy programs run here."""

from navette.ros2.names.hook import (
    install,
    installed_rclpy,
    is_installed,
    replaced_packages,
    uninstall,
)

__all__ = [
    "install",
    "installed_rclpy",
    "is_installed",
    "replaced_packages",
    "uninstall",
]
