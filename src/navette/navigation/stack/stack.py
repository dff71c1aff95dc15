"""The nodes of the stack in data-flow order."""

from dataclasses import dataclass

from navette.errors import UnknownNameError
from navette.navigation.arbiter.node import ArbiterNode
from navette.navigation.behaviors.node import BehaviorNode
from navette.navigation.control.node import ControlNode
from navette.navigation.costmap.node import CostmapNode
from navette.navigation.localization.distance.node import OdomIntegratorNode
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.localization.localizer.node import LocalizerNode
from navette.navigation.mapping.node import MapMemoryNode
from navette.navigation.missions.explore.node import ExplorerNode
from navette.navigation.missions.node import MissionNode
from navette.navigation.planning.node import PlannerNode
from navette.navigation.servers.lifecycle_manager import LifecycleManagerNode
from navette.runtime import Context, StageNode
from navette.sim.node import SimNode

FLOW = (
    "sim",
    "localization",
    "costmap",
    "mapping",
    "planning",
    "control",
    "behaviors",
    "arbiter",
    "missions",
)
"""The stages in data-flow order."""

NODE_CLASSES: tuple[tuple[str, type[StageNode]], ...] = (
    ("sim", SimNode),
    ("odom_integrator", OdomIntegratorNode),
    ("ekf", EkfNode),
    ("localizer", LocalizerNode),
    ("costmap", CostmapNode),
    ("map_memory", MapMemoryNode),
    ("planner", PlannerNode),
    ("control", ControlNode),
    ("behaviors", BehaviorNode),
    ("arbiter", ArbiterNode),
    ("missions", MissionNode),
    ("explorer", ExplorerNode),
    ("lifecycle_manager_navigation", LifecycleManagerNode),
)


def node_class(name: str) -> type[StageNode]:
    """Return the class of a stage that needs topics only, by its node's name.

    Raises:
        UnknownNameError: unknown stage; the text lists the known ones.
    """
    known = {each: kind for each, kind in NODE_CLASSES if kind is not SimNode}
    if name not in known:
        raise UnknownNameError.of("stage", name, list(known))
    return known[name]


@dataclass(frozen=True)
class NavigationStack:
    """The nodes between sensors and wheels; they communicate on topics only.

    Localization is not included: the simulator publishes the pose on the same topic.
    Start localization nodes by name where required.
    """

    localizer: LocalizerNode
    costmap: CostmapNode
    map_memory: MapMemoryNode
    planner: PlannerNode
    control: ControlNode
    behaviors: BehaviorNode
    arbiter: ArbiterNode
    missions: MissionNode
    lifecycle_manager: LifecycleManagerNode

    @classmethod
    def create(cls, context: Context) -> "NavigationStack":
        """Create all nodes, with the context's parameter overrides."""
        return cls(
            localizer=LocalizerNode(context=context),
            costmap=CostmapNode(context=context),
            map_memory=MapMemoryNode(context=context),
            planner=PlannerNode(context=context),
            control=ControlNode(context=context),
            behaviors=BehaviorNode(context=context),
            arbiter=ArbiterNode(context=context),
            missions=MissionNode(context=context),
            lifecycle_manager=LifecycleManagerNode(context=context),
        )
