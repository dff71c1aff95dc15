"""What a logger is called inside rclpy."""

from navette.runtime.log import Logger as RcutilsLogger

__all__ = [
    "RcutilsLogger",
]
