"""Behaviour trees as text."""

import re
from pathlib import Path
from typing import Any, cast

from py_trees.display import unicode_tree

from navette.navigation.missions.tree.behaviour import TreeNode
from navette.navigation.missions.tree.blackboard import TreeBlackboard
from navette.navigation.missions.tree.robot_access import RobotAccess
from navette.navigation.missions.tree.tree_file import TreeFile

_COLOUR = re.compile("\x1b\\[[0-9;]*m")


def tree_text(root: TreeNode) -> str:
    """Return the tree with the status of its nodes, one line each, without colours.

    Signs: ``*`` running, ``✓`` succeeded, ``✕`` failed, ``-`` idle; ``{-}`` sequence,
    ``{o}`` fallback, ``[-]`` and ``[o]`` reactive ones, ``-^-`` decorator.
    """
    return _COLOUR.sub("", unicode_tree(root, show_status=True)).rstrip()


def file_text(path: Path) -> str:
    """Return the tree of a file, without status.

    Raises:
        FileFormatError: the file is not a valid tree.
    """
    # The nodes are built to check them; nothing is ticked.
    robot = cast(RobotAccess, _NoRobot())
    root = TreeFile.read(path).build(robot, TreeBlackboard())
    return _COLOUR.sub("", unicode_tree(root)).rstrip()


class _NoRobot:
    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"a tree that is only shown has no robot: {name}")
