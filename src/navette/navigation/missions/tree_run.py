"""A behaviour tree that runs for one goal after another."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

from py_trees.common import Status

from navette.navigation.missions.tree.behaviour import IDLE, RUNNING, TreeNode
from navette.navigation.missions.tree.blackboard import TreeBlackboard
from navette.navigation.missions.tree.robot_access import RobotAccess
from navette.navigation.missions.tree.tree_file import TreeFile

STATUS_WORDS = {
    Status.INVALID: "IDLE",
    Status.RUNNING: "RUNNING",
    Status.SUCCESS: "SUCCESS",
    Status.FAILURE: "FAILURE",
}
"""BehaviorTree.CPP's words."""


@dataclass(frozen=True)
class StatusChange:
    """A node whose status changed in a tick."""

    node: str
    uid: int
    before: str
    now: str


class TreeRun:
    """The tree of a file with its blackboard; ticked from outside.

    Raises:
        FileFormatError: the tree cannot be built; names file, line and element.
    """

    def __init__(self, file: TreeFile, robot: RobotAccess) -> None:
        self.file = file
        self.blackboard = TreeBlackboard()
        self.root: TreeNode = file.build(robot, self.blackboard)
        self.nodes = [cast(TreeNode, node) for node in _depth_first(self.root)]
        self._statuses = [IDLE] * len(self.nodes)

    def set_entries(self, entries: Mapping[str, Any]) -> None:
        """Write blackboard entries."""
        for name, value in entries.items():
            self.blackboard.set(name, value)

    def tick(self) -> Status:
        """Tick the tree; return the root's status."""
        self.root.tick_once()
        return self.root.status

    def halt(self) -> None:
        """End everything that is under way."""
        self.root.stop(IDLE)

    @property
    def is_running(self) -> bool:
        return self.root.status is RUNNING

    def take_changes(self) -> list[StatusChange]:
        """Return the changes of status since the last call, in the tree's order."""
        now = [node.status for node in self.nodes]
        if now == self._statuses:  # mostly
            return []
        changes = [
            StatusChange(node.name, node.uid, STATUS_WORDS[old], STATUS_WORDS[new])
            for node, old, new in zip(self.nodes, self._statuses, now, strict=True)
            if old is not new
        ]
        self._statuses = now
        return changes


def _depth_first(node: Any) -> list[Any]:
    return [node] + [each for child in node.children for each in _depth_first(child)]
