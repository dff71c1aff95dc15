"""BehaviorTree.CPP's switches: tick the child of the case that a value equals."""

from typing import Any, ClassVar

from py_trees.composites import Selector

from navette.navigation.missions.tree.behaviour import Ports
from navette.navigation.missions.tree.controls import BranchNode, Ticks, halt
from navette.navigation.missions.tree.ports import Port, parse_text


def _ports(cases: int) -> Ports:
    ports = {"variable": Port(parse_text, required=True)}
    for number in range(1, cases + 1):
        ports[f"case_{number}"] = Port(parse_text, required=True)
    return ports


class SwitchNode(BranchNode, Selector):
    """Tick the child of the first equal case; the last child if no case is equal.

    Values are compared as text. When another case is selected, the running child is
    halted.
    """

    MEMORY = False
    CASES: ClassVar[int]

    def run(self) -> Ticks:
        selected = self._selected()
        for index, child in enumerate(self.children):
            if index != selected:
                halt(child)
        return (yield from self.tick_child(selected))

    def _selected(self) -> int:
        value = _text(self.input("variable"))
        for index in range(self.CASES):
            if value == _text(self.input(f"case_{index + 1}")):
                return index
        return self.CASES


def _text(value: Any) -> str | None:
    """Return a value as BehaviorTree.CPP writes it; None without a value."""
    if isinstance(value, bool):
        return str(int(value))
    return None if value is None else str(value)


class Switch2Node(SwitchNode):
    """Two cases and a default."""

    CASES, CHILDREN, PORTS = 2, (3, 3), _ports(2)


class Switch3Node(SwitchNode):
    """Three cases and a default."""

    CASES, CHILDREN, PORTS = 3, (4, 4), _ports(3)


class Switch4Node(SwitchNode):
    """Four cases and a default."""

    CASES, CHILDREN, PORTS = 4, (5, 5), _ports(4)


class Switch5Node(SwitchNode):
    """Five cases and a default."""

    CASES, CHILDREN, PORTS = 5, (6, 6), _ports(5)


class Switch6Node(SwitchNode):
    """Six cases and a default."""

    CASES, CHILDREN, PORTS = 6, (7, 7), _ports(6)
