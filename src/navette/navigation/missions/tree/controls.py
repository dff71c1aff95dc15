"""Control nodes: BehaviorTree.CPP's, and Nav2's PipelineSequence, RecoveryNode, …

Semantics follow BehaviorTree.CPP v4 and Nav2 (Macenski et al., "The Marathon 2: A
Navigation System", IROS 2020). Children that ended keep their status until the node
starts again, so that people can read it; running ones are halted when the node ends.
"""

from abc import abstractmethod
from collections.abc import Generator, Iterator
from typing import ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite, Parallel, Selector, Sequence

from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    IDLE,
    RUNNING,
    SUCCESS,
    NodeSetup,
    Ports,
    TreeNode,
)
from navette.navigation.missions.tree.ports import (
    Port,
    parse_bool,
    parse_count,
    parse_int,
)

Ticks = Generator[Behaviour, None, Status]


class BranchNode(TreeNode, Composite):
    """A node with children; :meth:`run` ticks them and returns the status."""

    MEMORY: ClassVar[bool] = True
    CHILDREN: ClassVar[tuple[int, int | None]] = (1, None)

    def __init__(self, setup: NodeSetup) -> None:
        Composite.__init__(self, setup.name, setup.children)
        self.memory = self.MEMORY
        self.equip(setup)
        self.index = 0

    def begin(self) -> None:
        """Override to reset the state that a run keeps."""
        self.index = 0

    @abstractmethod
    def run(self) -> Ticks:
        """Tick children and return the status of this node."""

    def tick(self) -> Iterator[Behaviour]:
        if self.status is not RUNNING:
            for child in self.children:
                halt(child)
            self.begin()
        status = yield from self.run()
        if status is not RUNNING:
            for child in self.children:
                if child.status is RUNNING:
                    halt(child)
            self.stop(status)
        self.status = status
        yield self

    def stop(self, new_status: Status = IDLE) -> None:
        Composite.stop(self, new_status)

    def tick_child(self, index: int) -> Ticks:
        """Tick a child and return its status; one that has ended starts again."""
        child = self.children[index]
        self.current_child = child
        yield from child.tick()
        return child.status

    def halt_after(self, index: int) -> None:
        """Halt the children behind one that runs."""
        for child in self.children[index + 1 :]:
            halt(child)


def halt(child: Behaviour) -> None:
    if child.status is not IDLE:
        child.stop(IDLE)


class SequenceNode(BranchNode, Sequence):
    """Tick the children in order until one fails; a running one is resumed."""

    def run(self) -> Ticks:
        while self.index < len(self.children):
            status = yield from self.tick_child(self.index)
            if status is not SUCCESS:
                if status is FAILURE:
                    self.on_failure()
                return status
            self.index += 1
        self.index = 0
        return SUCCESS

    def on_failure(self) -> None:
        """Start from the first child next time."""
        self.index = 0


class SequenceWithMemoryNode(SequenceNode):
    """As Sequence; after a failure the failed child is tried again, not the first."""

    def begin(self) -> None:
        """Keep the index, also when the parent ticks this node after a failure."""

    def on_failure(self) -> None:
        """Keep the index."""

    def terminate(self, new_status: Status) -> None:
        if new_status is IDLE and self.status is RUNNING:
            self.index = 0


class ReactiveSequenceNode(BranchNode, Sequence):
    """Tick all children again from the first, up to the one that runs."""

    MEMORY = False

    def run(self) -> Ticks:
        for index in range(len(self.children)):
            status = yield from self.tick_child(index)
            if status is not SUCCESS:
                self.halt_after(index)
                return status
        return SUCCESS


class FallbackNode(BranchNode, Selector):
    """Tick the children in order until one succeeds; a running one is resumed."""

    def run(self) -> Ticks:
        while self.index < len(self.children):
            status = yield from self.tick_child(self.index)
            if status is not FAILURE:
                return status
            self.index += 1
        return FAILURE


class ReactiveFallbackNode(BranchNode, Selector):
    """Tick all children again from the first, up to the one that runs."""

    MEMORY = False

    def run(self) -> Ticks:
        for index in range(len(self.children)):
            status = yield from self.tick_child(index)
            if status is not FAILURE:
                self.halt_after(index)
                return status
        return FAILURE


class ParallelNode(BranchNode, Parallel):
    """Tick all children; end by the number that succeeded or failed."""

    PORTS: ClassVar[Ports] = {
        "success_count": Port(parse_int, "-1"),
        "failure_count": Port(parse_int, "1"),
    }

    def run(self) -> Ticks:
        total = len(self.children)
        needed = _count(self.input("success_count"), total)
        allowed = _count(self.input("failure_count"), total)
        for index, child in enumerate(self.children):
            if child.status in (IDLE, RUNNING):
                yield from self.tick_child(index)
        succeeded = sum(child.status is SUCCESS for child in self.children)
        failed = sum(child.status is FAILURE for child in self.children)
        if succeeded >= needed:
            return SUCCESS
        if failed >= allowed or total - failed < needed:
            return FAILURE
        return RUNNING


class ParallelAllNode(BranchNode, Parallel):
    """Tick all children to their end; fail if too many failed."""

    PORTS: ClassVar[Ports] = {"max_failures": Port(parse_int, "1")}

    def run(self) -> Ticks:
        for index, child in enumerate(self.children):
            if child.status in (IDLE, RUNNING):
                yield from self.tick_child(index)
        if any(child.status is RUNNING for child in self.children):
            return RUNNING
        failed = sum(child.status is FAILURE for child in self.children)
        limit = _count(self.input("max_failures"), len(self.children))
        return FAILURE if failed >= limit else SUCCESS


class IfThenElseNode(BranchNode, Selector):
    """Condition, branch if it succeeds, optional branch if it fails."""

    CHILDREN = (2, 3)

    def run(self) -> Ticks:
        if self.index == 0:
            status = yield from self.tick_child(0)
            if status is RUNNING:
                return RUNNING
            self.index = 1 if status is SUCCESS else 2
        if self.index >= len(self.children):
            return FAILURE
        return (yield from self.tick_child(self.index))


class WhileDoElseNode(BranchNode, Selector):
    """Like IfThenElse, with the condition ticked every time."""

    MEMORY = False
    CHILDREN = (2, 3)

    def run(self) -> Ticks:
        status = yield from self.tick_child(0)
        if status is RUNNING:
            return RUNNING
        index, other = (1, 2) if status is SUCCESS else (2, 1)
        if other < len(self.children):
            halt(self.children[other])
        if index >= len(self.children):
            return FAILURE
        return (yield from self.tick_child(index))


class PipelineSequenceNode(BranchNode, Sequence):
    """Nav2: tick earlier children again while a later one runs.

    A child that runs again does not keep those behind it, which were reached before,
    from being ticked: the path is planned again while the robot follows the last one.
    """

    def run(self) -> Ticks:
        for index in range(len(self.children)):
            status = yield from self.tick_child(index)
            if status is FAILURE:
                return FAILURE
            if status is RUNNING and index >= self.index:
                self.index = index
                return RUNNING
        return SUCCESS


class RecoveryControlNode(BranchNode, Selector):
    """Nav2: on failure of the first child tick the second, then the first again."""

    PORTS: ClassVar[Ports] = {"number_of_retries": Port(parse_count, "1")}
    CHILDREN = (2, 2)

    def begin(self) -> None:
        super().begin()
        self._retries = 0

    def run(self) -> Ticks:
        limit = self.input("number_of_retries")
        while True:
            if self.index == 0:
                status = yield from self.tick_child(0)
                if status is not FAILURE:
                    return status
                if self._retries >= limit >= 0:
                    return FAILURE
                halt(self.children[1])
                self.index = 1
            status = yield from self.tick_child(1)
            if status is not SUCCESS:
                return status
            halt(self.children[0])
            self.index = 0
            self._retries += 1
            self.feedback_message = f"retry {self._retries}" + (
                f" of {limit}" if limit >= 0 else ""
            )
            if limit < 0:
                return RUNNING  # without a limit, an immediate failure would not end


class RoundRobinNode(BranchNode, Selector):
    """Nav2: tick the next child each time it starts; succeed when one succeeds.

    After the last child, the first one is next, whatever ``wrap_around`` of Lyrical
    is: its value false lets a recovery that succeeded as the last one count as failed.
    """

    PORTS: ClassVar[Ports] = {"wrap_around": Port(parse_bool, "false")}

    def begin(self) -> None:
        """Keep the index: the next recovery shall be another one."""
        self._failed = 0

    def terminate(self, new_status: Status) -> None:
        if new_status is IDLE and self.status is RUNNING:
            self.index = 0

    def run(self) -> Ticks:
        while self._failed < len(self.children):
            status = yield from self.tick_child(self.index)
            if status is RUNNING:
                return RUNNING
            self.index = (self.index + 1) % len(self.children)
            if status is SUCCESS:
                return SUCCESS
            self._failed += 1
        self.index = 0
        return FAILURE


def _count(value: int, total: int) -> int:
    """Return a number of children; negative counts from the end, as -1 = all."""
    return max(total + 1 + value, 0) if value < 0 else value
