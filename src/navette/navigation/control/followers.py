"""The controllers by name."""

from navette.navigation.control.command_follower import CommandFollower
from navette.navigation.control.follower import Follower
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.omni_tracking import OmniTracking
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_follower import PathFollower

__all__ = ["Follower", "OmniTracking", "make_follower"]


def make_follower(params: ControlParams) -> Follower:
    """Return the controller of ``params.method``."""
    method = CONTROLLERS.load(params.method)
    if method.entry == "command":
        return CommandFollower(params, method.make(params), method.name)
    if method.entry == "curvature":
        return PathFollower(params)
    follower: Follower = method.make(params)
    return follower
