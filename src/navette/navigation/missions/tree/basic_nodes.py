"""Leaves of BehaviorTree.CPP: blackboard, fixed results, waiting."""

from typing import ClassVar

from py_trees.common import Status

from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    SUCCESS,
    LeafNode,
    NodeSetup,
    Ports,
)
from navette.navigation.missions.tree.ports import (
    Port,
    parse_int,
)


class SetBlackboardNode(LeafNode):
    """Write a blackboard entry."""

    PORTS: ClassVar[Ports] = {
        "value": Port(required=True),
        "output_key": Port(required=True),
    }

    def __init__(self, setup: NodeSetup) -> None:
        super().__init__(setup)
        self._key = setup.attributes["output_key"].strip("{} ")

    def update(self) -> Status:
        self.blackboard.set(self._key, self.input("value"))
        return SUCCESS


class UnsetBlackboardNode(LeafNode):
    """Remove a blackboard entry."""

    PORTS: ClassVar[Ports] = {"key": Port(required=True)}

    def update(self) -> Status:
        self.blackboard.unset(str(self._attributes["key"]).strip("{} "))
        return SUCCESS


class AlwaysSuccessNode(LeafNode):
    """Succeed."""

    def update(self) -> Status:
        return SUCCESS


class AlwaysFailureNode(LeafNode):
    """Fail."""

    def update(self) -> Status:
        return FAILURE


class SleepNode(LeafNode):
    """Run for a time, then succeed; the robot is not stopped by it."""

    PORTS: ClassVar[Ports] = {"msec": Port(parse_int, required=True)}

    def initialise(self) -> None:
        super().initialise()
        self._start_ns = self.robot.now_ns

    def update(self) -> Status:
        passed = self.seconds_since(self._start_ns) * 1000 >= self.input("msec")
        return SUCCESS if passed else Status.RUNNING
