"""nav2_simple_commander: navigation as a Python library, over Nav2's interfaces."""

from navette.ros2.packages.nav2_simple_commander.robot_navigator import (
    BasicNavigator,
    TaskResult,
)

__all__ = ["BasicNavigator", "TaskResult"]
