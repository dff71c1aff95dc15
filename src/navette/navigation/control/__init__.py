"""Control: path, odometry and costmap in, velocity command out."""

from navette.navigation.control.command_gate import CommandGate, InputAges
from navette.navigation.control.followers import Follower, make_follower
from navette.navigation.control.limits import STOP, VelocityCommand
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_follower import PathFollower
from navette.navigation.control.predictive_follower import PredictiveFollower
from navette.navigation.control.records import FollowerInputs, FollowerOutput
from navette.navigation.control.states import ControlState

__all__ = [
    "Follower",
    "PathFollower",
    "PredictiveFollower",
    "make_follower",
    "FollowerInputs",
    "FollowerOutput",
    "ControlState",
    "ControlParams",
    "VelocityCommand",
    "STOP",
    "CommandGate",
    "InputAges",
]
