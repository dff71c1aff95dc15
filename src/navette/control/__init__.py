"""What to do now: path, odometry and costmap → command."""

from navette.control.command_gate import CommandGate, InputAges
from navette.control.limits import STOP, Command, MotionLimits
from navette.control.obstacles import obstacle_points
from navette.control.params import ControlParams
from navette.control.path_follower import PathFollower
from navette.control.records import FollowerInputs, FollowerOutput
from navette.control.states import ControlState

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
