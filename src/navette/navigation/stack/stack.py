"""The nodes of the stack in data-flow order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from navette.navigation.arbiter.node import ArbiterNode
from navette.navigation.control.node import ControlNode
from navette.navigation.control.params import ControlParams
from navette.navigation.missions.node import MissionNode
from navette.navigation.servers.lifecycle_manager import LifecycleManagerNode
from navette.navigation.stack.programs import (
    MakeNode,
    check_replaceable,
    default_context,
)
from navette.navigation.stack.stage_classes import node_class
from navette.runtime import Context, Node

FLOW = (
    "sim",
    "localization",
    "slam",
    "costmap",
    "tracking",
    "mapping",
    "planning",
    "control",
    "behaviors",
    "arbiter",
    "missions",
)
"""The stages in data-flow order."""

_NOTHING: Mapping[str, MakeNode] = MappingProxyType({})


@dataclass(frozen=True)
class NavigationStack:
    """The nodes between sensors and wheels; they communicate on topics only.

    The first of the localization nodes publishes the pose as Nav2's localizer does.
    """

    localization: tuple[Node, ...]
    costmap: Node
    tracking: Node
    map_memory: Node
    planner: Node
    control: Node
    behaviors: Node
    arbiter: ArbiterNode
    missions: MissionNode
    lifecycle_manager: LifecycleManagerNode

    @classmethod
    def create(
        cls,
        context: Context,
        replacements: Mapping[str, MakeNode] = _NOTHING,
        localization: Sequence[str] = ("localizer",),
    ) -> "NavigationStack":
        """Create all nodes, with the context's parameter overrides.

        Args:
            context: context of the nodes.
            replacements: nodes of the stack → what makes the node instead.
            localization: names of the nodes that locate the robot.

        Raises:
            UnknownNameError: no such node, or one that cannot be replaced.
        """
        check_replaceable(replacements)

        def made(name: str) -> Node:
            if name in replacements:
                with default_context(context):
                    return replacements[name](context)
            kind: Callable[..., Node] = node_class(name)
            return kind(context=context)

        return cls(
            localization=tuple(map(made, localization)),
            costmap=made("costmap"),
            tracking=made("tracking"),
            map_memory=made("map_memory"),
            planner=made("planner"),
            control=made("control"),
            behaviors=made("behaviors"),
            arbiter=ArbiterNode(context=context),
            missions=MissionNode(context=context),
            lifecycle_manager=LifecycleManagerNode(context=context),
        )

    @property
    def nodes(self) -> tuple[Node, ...]:
        """All nodes in data-flow order."""
        localization, *others = vars(self).values()
        return (*localization, *others)

    @property
    def cruise_speed_mps(self) -> float | None:
        """Cruise speed of the controller; None: it is not Navette's."""
        if isinstance(self.control, ControlNode):
            params: ControlParams = self.control.params
            return params.cruise_speed_mps
        return None
