"""The nodes that locate the robot in a run."""

from collections.abc import Mapping
from types import MappingProxyType

from navette.sim.params import SimParams

_LOCATORS: Mapping[str, str] = MappingProxyType(
    {"truth": "localizer", "odometry": "localizer", "amcl": "amcl", "slam": "slam"}
)
"""Source of the pose (``SimParams.locator``) → name of the node."""

# Publishes the odometry if the simulator does not.
_FILTER = "ekf"

LOCALIZATION_NODES = (_FILTER, *dict.fromkeys(_LOCATORS.values()))
"""Names of all these nodes."""


def localization_nodes(sim: SimParams) -> tuple[str, ...]:
    """Return the names of the nodes that locate the robot, in flow order."""
    locator = _LOCATORS[sim.locator]
    return (_FILTER, locator) if sim.filters_odometry else (locator,)
