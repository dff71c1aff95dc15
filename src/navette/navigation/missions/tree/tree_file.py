"""Behaviour trees from XML in BehaviorTree.CPP v4's words.

``<root BTCPP_format="4" main_tree_to_execute="MainTree">`` contains trees, each
``<BehaviorTree ID="…">`` one node; ``<SubTree ID="…"/>`` inserts another of them and
``<include path="…"/>`` another file. A tree file is untrusted: size, nesting and number
of nodes are limited, and unknown nodes, ports and values are errors with file and line.
"""

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from navette.errors import FileFormatError
from navette.navigation.missions.tree.behaviour import NodeSetup, TreeNode
from navette.navigation.missions.tree.blackboard import TreeBlackboard
from navette.navigation.missions.tree.catalog import (
    CATEGORIES,
    KINDS,
    NO_SERVER,
    Kind,
)
from navette.navigation.missions.tree.controls import BranchNode
from navette.navigation.missions.tree.decorators import DecoratorNode
from navette.navigation.missions.tree.ports import KINDS as PORT_KINDS
from navette.navigation.missions.tree.ports import entry_of, parse_bool, parse_message
from navette.navigation.missions.tree.robot_access import RobotAccess
from navette.sim.xml_tree import XmlNode, parse_xml

MAX_NODES = 2000
MAX_INCLUDES = 16
_IGNORED = ("name", "ID", "_description", "_uid", "_fullpath")
# BehaviorTree.CPP's scripts: attributes of any element, and nodes.
_SCRIPTS = (
    *("_skipIf", "_failureIf", "_successIf", "_while"),
    *("_onSuccess", "_onFailure", "_onHalted", "_post"),
)
_SCRIPT_NODES = ("Script", "ScriptCondition", "Precondition")
_INSTEAD = (
    "scripts are not supported; use IfThenElse, WhileDoElse or Switch with a condition "
    "node, and SetBlackboard"
)
# Attributes of <SubTree> that are not ports.
_SUBTREE = ("ID", "name", "_autoremap", "__shared_blackboard")


@dataclass
class TreeFile:
    """The trees of a file and of the files that it includes.

    Attributes:
        path: the file.
        trees: their root elements by ID.
        main: ID of the tree that runs.
    """

    path: Path
    trees: dict[str, XmlNode]
    main: str

    @classmethod
    def read(cls, path: Path) -> "TreeFile":
        """Read and check a file.

        Raises:
            FileFormatError: names file, line, element and what is allowed.
        """
        trees: dict[str, XmlNode] = {}
        root = _read_into(path, trees, [])
        file = cls(path, trees, _main_of(root, trees))
        _check_recursion(file, [file.main], set())
        return file

    def build(self, robot: RobotAccess, blackboard: TreeBlackboard) -> TreeNode:
        """Return the root of a new tree.

        Raises:
            FileFormatError: unknown node or port, wrong value or number of children.
        """
        return _Builder(self, robot).build(self.trees[self.main], blackboard)


def _read_into(path: Path, trees: dict[str, XmlNode], within: list[Path]) -> XmlNode:
    root = parse_xml(path)
    if root.tag != "root":
        raise root.error("expected <root> with <BehaviorTree> elements")
    version = root.attributes.get("BTCPP_format", "4")
    if version != "4":
        raise root.error(f"BTCPP_format is {version!r}; expected '4'")
    inside = [*within, path.resolve()]
    for child in root.children:
        if child.tag == "BehaviorTree":
            _add_tree(child, trees, root)
        elif child.tag == "include":
            other = path.parent / child.need_attribute("path")
            if other.resolve() in inside or len(inside) > MAX_INCLUDES:
                raise child.error(f"{other} is already being read")
            _read_into(other, trees, inside)
        elif child.tag != "TreeNodesModel":
            known = "BehaviorTree, include, TreeNodesModel"
            raise child.error(f"unknown element; known here: {known}")
    return root


def _add_tree(element: XmlNode, trees: dict[str, XmlNode], root: XmlNode) -> None:
    name = element.attributes.get("ID") or f"tree at line {element.line}"
    if name in trees:
        raise element.error(f"a tree with ID {name!r} exists already")
    if len(element.children) != 1:
        raise element.error(f"{len(element.children)} nodes; expected exactly one")
    trees[name] = element


def _main_of(root: XmlNode, trees: Mapping[str, XmlNode]) -> str:
    main = root.attributes.get("main_tree_to_execute")
    if main is None:
        own = [each for each in root.children if each.tag == "BehaviorTree"]
        if len(own) != 1:
            raise root.error(
                f"{len(own)} trees and no attribute main_tree_to_execute; known: "
                f"{', '.join(trees) or 'none'}"
            )
        return next(name for name, each in trees.items() if each is own[0])
    if main not in trees:
        raise root.error(
            f"main_tree_to_execute {main!r} does not exist; known: "
            f"{', '.join(trees) or 'none'}"
        )
    return main


def _check_recursion(file: TreeFile, stack: list[str], checked: set[str]) -> None:
    """Refuse unknown trees and trees that contain themselves; each is visited once."""
    for element in _subtrees(file.trees[stack[-1]].children):
        name = element.need_attribute("ID")
        if name not in file.trees:
            raise element.error(
                f"unknown tree {name!r}; known: {', '.join(sorted(file.trees))}"
            )
        if name in stack:
            raise element.error(f"tree {name!r} contains itself")
        if name not in checked:
            _check_recursion(file, [*stack, name], checked)
    checked.add(stack[-1])


def _subtrees(elements: Iterable[XmlNode]) -> Iterable[XmlNode]:
    for element in elements:
        if element.tag == "SubTree":
            yield element
        yield from _subtrees(element.children)


@dataclass
class _Builder:
    file: TreeFile
    robot: RobotAccess
    count: int = field(default=0)

    def build(self, tree: XmlNode, blackboard: TreeBlackboard) -> TreeNode:
        return self._node(tree.children[0], blackboard)

    def _node(self, element: XmlNode, blackboard: TreeBlackboard) -> TreeNode:
        self.count += 1
        uid = self.count
        if uid > MAX_NODES:
            raise element.error(f"more than {MAX_NODES} nodes")
        _refuse_scripts(element)
        if element.tag == "SubTree":
            return self._subtree(element, blackboard, uid)
        tag, kind = _kind_of(element)
        attributes = _ports_of(element, tag, kind)
        _check_children(element, kind)
        children = [self._node(child, blackboard) for child in element.children]
        setup = NodeSetup(
            tag=tag,
            name=element.attributes.get("name") or tag,
            attributes=attributes,
            children=list(children),
            blackboard=blackboard,
            robot=self.robot,
            element=element,
            uid=uid,
        )
        return kind(setup)

    def _subtree(
        self, element: XmlNode, blackboard: TreeBlackboard, uid: int
    ) -> TreeNode:
        name = element.need_attribute("ID")
        own = {k: v for k, v in element.attributes.items() if k not in _SUBTREE}
        remapped = {}
        for port, text in own.items():
            entry = entry_of(text)
            if entry is not None:
                remapped[port] = entry or port
        shared = element.attributes.get("_autoremap", "false")
        inner = TreeBlackboard(blackboard, remapped, shares_all=_flag(element, shared))
        for port, text in own.items():
            if port not in remapped:
                inner.set(port, text)
        if element.children:
            raise element.error("has children; expected none")
        setup = NodeSetup(
            tag="SubTree",
            name=element.attributes.get("name") or name,
            attributes={},
            children=[self.build(self.file.trees[name], inner)],
            blackboard=blackboard,
            robot=self.robot,
            element=element,
            uid=uid,
        )
        return KINDS["SubTree"](setup)


def _refuse_scripts(element: XmlNode) -> None:
    for name in _SCRIPTS:
        if name in element.attributes:
            text = element.attributes[name]
            raise element.error(f"{name}={text!r}: {_INSTEAD}")
    if element.attributes.get("ID", element.tag) in _SCRIPT_NODES:
        raise element.error(_INSTEAD)


def _flag(element: XmlNode, text: str) -> bool:
    try:
        return parse_bool(text)
    except ValueError as error:
        raise element.error(f"attribute '_autoremap': {error}") from None


def _kind_of(element: XmlNode) -> tuple[str, Kind]:
    base = CATEGORIES.get(element.tag)
    tag = element.tag if base is None else element.need_attribute("ID")
    kind = KINDS.get(tag)
    if tag in NO_SERVER:
        raise element.error(
            f"{tag} needs {NO_SERVER[tag]}, which Navette does not have"
        )
    if kind is None:
        near = difflib.get_close_matches(tag, KINDS, n=1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise element.error(f"unknown node {tag!r}; {hint}known: {', '.join(KINDS)}")
    if base is not None and not issubclass(kind, base):
        raise element.error(f"{tag} is not of the category {element.tag}")
    return tag, kind


def _ports_of(element: XmlNode, tag: str, kind: Kind) -> dict[str, str]:
    """Return the ports as written, checked against the kind's."""
    ports = kind.PORTS
    given = {k: v for k, v in element.attributes.items() if k not in _IGNORED}
    for name, text in given.items():
        port = ports.get(name)
        if port is None:
            raise element.error(
                f"{tag} has no port {name!r}; known: {', '.join(ports) or 'none'}"
            )
        if port.output or entry_of(text) is not None or port.parse is parse_message:
            if entry_of(text) is None and port.parse is parse_message and text:
                _need_entry(element, name, text, output=port.output)
            continue
        try:
            port.parse(text)
        except ValueError:
            raise element.error(
                f"port {name!r} is {text!r}; expected {PORT_KINDS[port.parse]}"
            ) from None
    for name, port in ports.items():
        if port.required and name not in given:
            raise element.error(f"{tag}: port {name!r} is missing")
    return given


def _need_entry(element: XmlNode, name: str, text: str, *, output: bool) -> None:
    """Refuse a literal where only a blackboard entry makes sense."""
    if not output:
        raise element.error(f"port {name!r} is {text!r}; expected an entry as {{goal}}")


def _check_children(element: XmlNode, kind: Kind) -> None:
    count = len(element.children)
    if issubclass(kind, DecoratorNode):
        low, high = 1, 1
    elif issubclass(kind, BranchNode):
        low, high = kind.CHILDREN[0], kind.CHILDREN[1] or MAX_NODES
    else:
        low, high = 0, 0
    if not low <= count <= high:
        allowed = str(low) if low == high else f"{low} or more"
        if low < high < MAX_NODES:
            allowed = f"{low} to {high}"
        raise element.error(f"{count} children; expected {allowed}")


def text_of(error: FileFormatError) -> str:
    """Return the error's text in one line."""
    return " ".join(str(error).split())
