"""Leaves that call Nav2's services, or cancel the goals of its actions."""

from typing import Any, ClassVar

from navette.navigation.missions.tree.behaviour import (
    Ports,
)
from navette.navigation.missions.tree.calls import (
    CallLeaf,
    ServiceLeaf,
)
from navette.navigation.missions.tree.interfaces import interface
from navette.navigation.missions.tree.ports import (
    Port,
    parse_float,
    parse_message,
    parse_milliseconds,
)
from navette.navigation.missions.tree.robot_access import ServerCall

# The stack's costmaps have no plugins: they are cleared as a whole.
_CLEAR: Ports = {**ServiceLeaf.PORTS, "plugins": Port()}


class ClearEntireCostmapNode(ServiceLeaf):
    """Clear a costmap."""

    TYPE, IS_RECOVERY = "nav2_msgs/srv/ClearEntireCostmap", True
    PORTS: ClassVar[Ports] = _CLEAR


class ClearCostmapExceptRegionNode(ServiceLeaf):
    """Clear a costmap except around the robot."""

    TYPE, IS_RECOVERY = "nav2_msgs/srv/ClearCostmapExceptRegion", True
    PORTS: ClassVar[Ports] = {
        "reset_distance": Port(parse_float, "1.0"),
        **_CLEAR,
    }

    def request(self) -> Any:
        kind = interface(self.TYPE)
        return kind.Request(reset_distance=self.input("reset_distance"))


class ClearCostmapAroundRobotNode(ClearCostmapExceptRegionNode):
    """Clear a costmap around the robot."""

    TYPE = "nav2_msgs/srv/ClearCostmapAroundRobot"


class ClearCostmapAroundPoseNode(ServiceLeaf):
    """Clear a costmap around a pose."""

    TYPE, IS_RECOVERY = "nav2_msgs/srv/ClearCostmapAroundPose", True
    PORTS: ClassVar[Ports] = {
        "pose": Port(parse_message, required=True),
        "reset_distance": Port(parse_float, "1.0"),
        **_CLEAR,
    }

    def request(self) -> Any:
        return interface(self.TYPE).Request(
            pose=self.needed("pose"), reset_distance=self.input("reset_distance")
        )


class ReinitializeGlobalLocalizationNode(ServiceLeaf):
    """Distribute the localization's particles over the map."""

    TYPE = "std_srvs/srv/Empty"
    PORTS: ClassVar[Ports] = {
        "service_name": Port(default="reinitialize_global_localization"),
        "server_timeout": Port(parse_milliseconds),
    }


class CancelNode(CallLeaf):
    """Cancel the goals of a server."""

    ACTION: ClassVar[str]
    SERVER: ClassVar[str]
    PORTS: ClassVar[Ports] = {
        "server_name": Port(),
        "server_timeout": Port(parse_milliseconds),
    }

    def start(self) -> ServerCall:
        name = self.input("server_name") or self.SERVER
        return self.robot.cancel_all(f"nav2_msgs/action/{self.ACTION}", name)


class CancelControlNode(CancelNode):
    """Stop following a path."""

    ACTION, SERVER = "FollowPath", "follow_path"


class CancelBackUpNode(CancelNode):
    """Stop backing up."""

    ACTION, SERVER = "BackUp", "backup"


class CancelDriveOnHeadingNode(CancelNode):
    """Stop driving on a heading."""

    ACTION, SERVER = "DriveOnHeading", "drive_on_heading"


class CancelSpinNode(CancelNode):
    """Stop turning."""

    ACTION, SERVER = "Spin", "spin"


class CancelAssistedTeleopNode(CancelNode):
    """End the operator's driving."""

    ACTION, SERVER = "AssistedTeleop", "assisted_teleop"


class CancelWaitNode(CancelNode):
    """Stop waiting."""

    ACTION, SERVER = "Wait", "wait"
