"""What to do now: path, odometry and costmap → command."""

from navette.navigation.control.command_gate import CommandGate, InputAges
from navette.navigation.control.limits import STOP, Command, MotionLimits
from navette.navigation.control.obstacles import obstacle_points
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_follower import PathFollower
from navette.navigation.control.records import FollowerInputs, FollowerOutput
from navette.navigation.control.states import ControlState

__all__ = [
    "PathFollower",
    "FollowerInputs",
    "FollowerOutput",
    "ControlState",
    "ControlParams",
    "Command",
    "STOP",
    "MotionLimits",
    "CommandGate",
    "InputAges",
    "obstacle_points",
]
