"""nav2_common.launch: parameter files that a launch file adapts."""

from navette.ros2.packages.nav2_common.launch.parse_multirobot_pose import (
    ParseMultiRobotPose,
)
from navette.ros2.packages.nav2_common.launch.rewritten_files import (
    HasNodeParams,
    ReplaceString,
    RewrittenYaml,
)

__all__ = ["HasNodeParams", "ParseMultiRobotPose", "ReplaceString", "RewrittenYaml"]
