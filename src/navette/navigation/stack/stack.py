"""The nodes of a driving robot, in the order data flows."""

from dataclasses import dataclass

from navette.errors import UnknownNameError
from navette.navigation.control.node import ControlNode
from navette.navigation.costmap.node import CostmapNode
from navette.navigation.localization.distance.node import OdomIntegratorNode
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.mapping.node import MapMemoryNode
from navette.navigation.missions.node import MissionNode
from navette.navigation.planning.node import PlannerNode
from navette.runtime import Context, StageNode
from navette.sim.node import SimNode

FLOW = ("sim", "localization", "costmap", "mapping", "planning", "control", "missions")
"""The stages, in the order data flows through them."""

NODE_CLASSES: tuple[tuple[str, type[StageNode]], ...] = (
    ("sim", SimNode),
    ("odom_integrator", OdomIntegratorNode),
    ("ekf", EkfNode),
    ("costmap", CostmapNode),
    ("map_memory", MapMemoryNode),
    ("planner", PlannerNode),
    ("control", ControlNode),
    ("missions", MissionNode),
)


def node_class(name: str) -> type[StageNode]:
    """The class of a stage that lives on topics alone, by its node's name.

    Raises:
        UnknownNameError: there is none; lists those there are.
    """
    known = {each: kind for each, kind in NODE_CLASSES if kind is not SimNode}
    if name not in known:
        raise UnknownNameError.of("stage", name, list(known))
    return known[name]


@dataclass(frozen=True)
class NavigationStack:
    """The nodes between sensors and wheels; they meet on topics only.

    Those of localization are not among them: the simulator says where its robot is, on
    the same topic as they do. They are started by name beside what needs them.
    """

    costmap: CostmapNode
    map_memory: MapMemoryNode
    planner: PlannerNode
    control: ControlNode
    missions: MissionNode

    @classmethod
    def create(cls, context: Context) -> "NavigationStack":
        """All nodes, with the parameters that the context's overrides give."""
        return cls(
            costmap=CostmapNode(context=context),
            map_memory=MapMemoryNode(context=context),
            planner=PlannerNode(context=context),
            control=ControlNode(context=context),
            missions=MissionNode(context=context),
        )
