"""ROS 2's module names for Navette's modules: unmodified rclpy programs run here."""

from navette.interop.hook import (
    install,
    installed_rclpy,
    is_installed,
    uninstall,
)

__all__ = ["install", "installed_rclpy", "is_installed", "uninstall"]
