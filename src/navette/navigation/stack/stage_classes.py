"""The nodes of a run and their classes, which are imported when they are needed.

A drive without SLAM, AMCL, the filter, zones and exploration starts 0.1 s earlier.
"""

from navette.errors import UnknownNameError
from navette.runtime import StageNode

_LOCATING = ("odom_integrator", "ekf", "localizer", "amcl", "slam")
_PERCEIVING = ("costmap", "tracking", "map_memory", "zones")
_ACTING = (
    "planner",
    "control",
    "behaviors",
    "reflex",
    "arbiter",
    "missions",
    "explorer",
    "lifecycle_manager_navigation",
)


def node_class(name: str) -> type[StageNode]:
    """Return the class of a stage that needs topics only, by its node's name.

    Raises:
        UnknownNameError: unknown stage; the text lists the known ones.
    """
    if name in _LOCATING:
        return _locating(name)
    if name in _PERCEIVING:
        return _perceiving(name)
    if name in _ACTING:
        return _acting(name)
    known = [*_LOCATING, *_PERCEIVING, *_ACTING]
    raise UnknownNameError.of("stage", name, known)


def node_classes() -> tuple[tuple[str, type[StageNode]], ...]:
    """Return name and class of all nodes, with the simulator, in data-flow order."""
    from navette.sim.node import SimNode

    stages = (*_LOCATING, *_PERCEIVING, *_ACTING)
    return (("sim", SimNode), *((name, node_class(name)) for name in stages))


def _locating(name: str) -> type[StageNode]:
    match name:
        case "odom_integrator":
            from navette.navigation.localization.distance.node import (
                OdomIntegratorNode,
            )

            return OdomIntegratorNode
        case "ekf":
            from navette.navigation.localization.ekf.node import EkfNode

            return EkfNode
        case "localizer":
            from navette.navigation.localization.localizer.node import (
                LocalizerNode,
            )

            return LocalizerNode
        case "amcl":
            from navette.navigation.localization.amcl.node import AmclNode

            return AmclNode
        case _:
            from navette.navigation.slam.node import SlamNode

            return SlamNode


def _perceiving(name: str) -> type[StageNode]:
    match name:
        case "costmap":
            from navette.navigation.costmap.node import CostmapNode

            return CostmapNode
        case "tracking":
            from navette.navigation.tracking.node import TrackingNode

            return TrackingNode
        case "map_memory":
            from navette.navigation.mapping.node import MapMemoryNode

            return MapMemoryNode
        case _:
            from navette.navigation.mapping.zones.node import ZonesNode

            return ZonesNode


def _acting(name: str) -> type[StageNode]:
    match name:
        case "planner":
            from navette.navigation.planning.node import PlannerNode

            return PlannerNode
        case "control":
            from navette.navigation.control.node import ControlNode

            return ControlNode
        case "behaviors":
            from navette.navigation.behaviors.node import BehaviorNode

            return BehaviorNode
        case "reflex":
            from navette.navigation.behaviors.reflex.node import ReflexNode

            return ReflexNode
        case "arbiter":
            from navette.navigation.arbiter.node import ArbiterNode

            return ArbiterNode
        case "missions":
            from navette.navigation.missions.node import MissionNode

            return MissionNode
        case "explorer":
            from navette.navigation.missions.explore.node import ExplorerNode

            return ExplorerNode
        case _:
            from navette.navigation.servers.lifecycle_manager import (
                LifecycleManagerNode,
            )

            return LifecycleManagerNode
