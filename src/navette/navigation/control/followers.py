"""The controllers by name."""

from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_follower import PathFollower
from navette.navigation.control.predictive_follower import PredictiveFollower


def make_follower(params: ControlParams) -> PathFollower | PredictiveFollower:
    """Return the controller of ``params.method``."""
    if params.method == "mppi":
        return PredictiveFollower(params)
    return PathFollower(params)
