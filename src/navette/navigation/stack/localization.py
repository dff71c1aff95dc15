"""The nodes that locate the robot in a run."""

from collections.abc import Mapping
from types import MappingProxyType

from navette.navigation.localization.amcl.node import AmclNode
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.localization.localizer.node import LocalizerNode
from navette.navigation.slam.node import SlamNode
from navette.runtime import StageNode
from navette.sim.params import SimParams

LOCALIZATIONS: Mapping[str, tuple[tuple[str, type[StageNode]], ...]] = MappingProxyType(
    {
        "truth": (("localizer", LocalizerNode),),
        "odometry": (("localizer", LocalizerNode),),
        "amcl": (("amcl", AmclNode),),
        "slam": (("slam", SlamNode),),
    }
)
"""Source of the pose (``SimParams.locator``) → name and class of the nodes."""

FILTER: tuple[str, type[StageNode]] = ("ekf", EkfNode)
"""The node that publishes the odometry if the simulator does not."""


def localization_nodes(sim: SimParams) -> tuple[tuple[str, type[StageNode]], ...]:
    """Return name and class of the nodes that locate the robot, in flow order."""
    nodes = LOCALIZATIONS[sim.locator]
    return (FILTER, *nodes) if sim.filters_odometry else nodes
