"""The kinds of tree nodes by their names in the XML."""

from navette.navigation.missions.tree import (
    actions,
    basic_nodes,
    conditions,
    controls,
    decorators,
    own_nodes,
    path_nodes,
    service_nodes,
    switches,
    tracking_nodes,
)
from navette.navigation.missions.tree.behaviour import LeafNode
from navette.navigation.missions.tree.controls import BranchNode
from navette.navigation.missions.tree.decorators import DecoratorNode

Kind = type[BranchNode] | type[DecoratorNode] | type[LeafNode]

_OTHER_NAMES = {"RecoveryControlNode": "RecoveryNode"}
_ABSTRACT = {"ActionLeaf", "CallLeaf", "ServiceLeaf"}


_MODULES = (
    controls,
    decorators,
    conditions,
    actions,
    service_nodes,
    path_nodes,
    basic_nodes,
    own_nodes,
    switches,
    tracking_nodes,
)


def _kinds() -> dict[str, Kind]:
    found: dict[str, Kind] = {}
    for module in _MODULES:
        for name, value in vars(module).items():
            is_kind = (
                isinstance(value, type)
                and issubclass(value, BranchNode | DecoratorNode | LeafNode)
                and value.__module__ == module.__name__
                and name.endswith("Node")
                and not name.startswith("_")
                and value not in _BASES
            )
            if is_kind:
                found[_OTHER_NAMES.get(name, name.removesuffix("Node"))] = value
    return dict(sorted(found.items()))


_BASES = {
    BranchNode,
    DecoratorNode,
    decorators.MappedStatusNode,
    decorators.CountedNode,
    decorators.PacedNode,
    service_nodes.CancelNode,
    path_nodes.SelectorNode,
    switches.SwitchNode,
}

KINDS: dict[str, Kind] = _kinds()
"""Every kind of node that a tree may contain."""

# Other names of a kind, in other versions of BehaviorTree.CPP and Nav2.
KINDS["SequenceStar"] = KINDS["SequenceWithMemory"]
KINDS["IsStopped"] = KINDS["CheckStopStatus"]

_ROUTES, _DOCKS = "Nav2's route server", "Nav2's docking server"
_FOLLOWS, _MONITOR = "Nav2's following server", "a collision monitor with a switch"
NO_SERVER = {
    "ComputeRoute": _ROUTES,
    "ComputeAndTrackRoute": _ROUTES,
    "CancelComputeAndTrackRoute": _ROUTES,
    "ExtractRouteNodesAsGoals": _ROUTES,
    "WouldARouteRecoveryHelp": _ROUTES,
    "DockRobot": _DOCKS,
    "UndockRobot": _DOCKS,
    "FollowObject": _FOLLOWS,
    "CancelFollowObject": _FOLLOWS,
    "ToggleCollisionMonitor": _MONITOR,
}
"""Nav2's nodes whose server the stack does not have, and that server."""

CATEGORIES = {
    "Action": LeafNode,
    "Condition": LeafNode,
    "Control": BranchNode,
    "Decorator": DecoratorNode,
}
"""Elements of the explicit form: ``<Action ID="Spin"/>`` instead of ``<Spin/>``."""
