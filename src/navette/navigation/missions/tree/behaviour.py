"""Base of the tree nodes: ports, blackboard and idle state on top of py_trees.

BehaviorTree.CPP's IDLE is py_trees' INVALID: a node in this state starts from the
beginning at its next tick.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from navette.navigation.missions.tree.blackboard import TreeBlackboard
from navette.navigation.missions.tree.ports import Port, entry_of
from navette.navigation.missions.tree.robot_access import RobotAccess
from navette.sim.xml_tree import XmlNode

IDLE, RUNNING = Status.INVALID, Status.RUNNING
SUCCESS, FAILURE = Status.SUCCESS, Status.FAILURE
Ports = dict[str, Port]


@dataclass
class NodeSetup:
    """What a node is made from.

    Attributes:
        name: that of the XML, or the tag.
        attributes: ports as written.
        element: the element of the file, for errors that name it and its line.
    """

    tag: str
    name: str
    attributes: dict[str, str]
    children: list[Behaviour]
    blackboard: TreeBlackboard
    robot: RobotAccess
    element: XmlNode
    uid: int = 0
    line: int = 0
    extra: dict[str, Any] = field(default_factory=dict)


class TreeNode(Behaviour):
    """A node with ports; mixed into py_trees' kinds of nodes."""

    PORTS: ClassVar[Ports] = {}

    tag: str
    uid: int
    _attributes: dict[str, str]
    blackboard: TreeBlackboard
    robot: RobotAccess

    def equip(self, setup: NodeSetup) -> None:
        """Store ports and accesses; called by the kinds' constructors."""
        self.tag, self.uid = setup.tag, setup.uid
        self._attributes = setup.attributes
        self._element = setup.element
        self.blackboard, self.robot = setup.blackboard, setup.robot

    def input(self, name: str) -> Any:
        """Return the value of an input port; None without a value.

        Raises:
            FileFormatError: the value is not of the port's kind.
        """
        try:
            return self.PORTS[name].read(self._attributes.get(name), self.blackboard)
        except ValueError as error:
            raise self._element.error(f"port {name!r}: {error}") from None

    def output(self, name: str, value: Any) -> None:
        """Write an output port, if it is connected."""
        text = self._attributes.get(name)
        port = self.PORTS[name]
        entry = port.entry if text is None else (entry_of(text) or text)
        if entry:
            self.blackboard.set(entry, value)

    def seconds_since(self, start_ns: int) -> float:
        return (self.robot.now_ns - start_ns) / 1e9


class LeafNode(TreeNode):
    """A node without children; :meth:`begin` runs when it starts from idle."""

    def __init__(self, setup: NodeSetup) -> None:
        super().__init__(setup.name)
        self.equip(setup)

    def begin(self) -> None:
        """Override to reset the state that a run keeps."""

    def halt(self) -> None:
        """Override to end what is under way; the node was running."""

    def tick(self) -> Iterator[Behaviour]:
        # Without the debug text of py_trees, and its check of a typed status.
        if self.status is not RUNNING:
            self.initialise()
        status = self.update()
        if status is not RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def initialise(self) -> None:
        if self.status is IDLE:
            self.begin()

    def terminate(self, new_status: Status) -> None:
        if new_status is IDLE and self.status is RUNNING:
            self.halt()


def to_status(value: object) -> Status:
    """Return success for a true value, failure otherwise."""
    return SUCCESS if value else FAILURE
