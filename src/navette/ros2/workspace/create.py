"""Make a package from the templates.

A template's text may hold ``$package``, ``$node``, …, its name ``{package}``, …: see
``_values``.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from string import Template

from navette.errors import FileFormatError, InvalidNameError
from navette.ros2.workspace.manifest import FILE_NAME

TEMPLATES = Path(__file__).parent / "templates"
_SUFFIX = ".template"  # so that no tool takes a template for the file it makes
_NAME = re.compile(r"[a-z](?:_?[a-z0-9]+)+")
_NODE_NAME = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*")
_MESSAGES = "_msgs"
#: What the templates depend on already.
_PYTHON_NEEDS = ("launch", "launch_ros", "rclpy", "std_msgs", "ament_index_python")
_MESSAGES_NEEDS = ("std_msgs", "builtin_interfaces", "action_msgs")


def create_package(
    name: str,
    folder: Path,
    *,
    node: str | None = None,
    messages: bool = False,
    dependencies: Sequence[str] = (),
) -> list[Path]:
    """Make a package below ``folder``; returns the folders of the packages made.

    A name that ends in ``_msgs`` gives a package of messages, services and actions,
    every other one a package with a node.

    Args:
        node: name of the node; the package's name if not given.
        messages: make a package ``<name>_msgs`` beside it, too, and depend on it.
        dependencies: further packages it needs.

    Raises:
        InvalidNameError: a name that ROS 2 does not allow.
        FileFormatError: the folder of that name is there already.
    """
    _check(name, _NAME, "package", "lower case letters, digits and single underscores")
    for each in dependencies:
        _check(each, re.compile(r"[a-zA-Z0-9][\w-]+", re.ASCII), "package", "letters")
    if name.endswith(_MESSAGES):
        if node is not None:
            raise InvalidNameError(
                f"{name!r} is a package of messages ({_MESSAGES}): it has no node"
            )
        needs = [each for each in dependencies if each not in _MESSAGES_NEEDS]
        return [_make("messages", folder / name, _values(name, name, needs))]
    node = node or name
    _check(node, _NODE_NAME, "node", "letters, digits and underscores")
    needs = [each for each in dependencies if each not in _PYTHON_NEEDS]
    if not messages:
        return [_make("python", folder / name, _values(name, node, needs))]
    own = name + _MESSAGES
    _refuse_existing(folder / own)
    needs = list(dict.fromkeys([own, *needs]))
    return [
        _make("python", folder / name, _values(name, node, needs)),
        _make("messages", folder / own, _values(own, own, [])),
    ]


def _check(name: str, pattern: re.Pattern[str], kind: str, allowed: str) -> None:
    if not pattern.fullmatch(name):
        raise InvalidNameError(
            f"{name!r} is not a valid {kind} name: wanted {allowed}, a letter first"
        )


def _values(package: str, node: str, needs: Sequence[str]) -> dict[str, str]:
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", node).lower().strip("_").split("_")
    module = "_".join(word for word in words if word).removesuffix("_node")
    return {
        "package": package,
        "node": node,
        "module": f"{module}_node",
        "Node": "".join(word.capitalize() for word in module.split("_")) + "Node",
        "dependencies": "".join(f"\n  <depend>{each}</depend>" for each in needs),
        "cmake_dependencies": "".join(
            f"\nfind_package({each} REQUIRED)" for each in needs
        ),
        "cmake_names": "".join(f" {each}" for each in needs),
    }


def _make(template: str, folder: Path, values: dict[str, str]) -> Path:
    _refuse_existing(folder)
    root = TEMPLATES / template
    for source in sorted(root.rglob(f"*{_SUFFIX}")):
        relative = str(source.relative_to(root)).removesuffix(_SUFFIX)
        target = folder / relative.format_map(values)
        target.parent.mkdir(parents=True, exist_ok=True)
        text = Template(source.read_text(encoding="utf-8")).substitute(values)
        target.write_text(text, encoding="utf-8")
    return folder


def _refuse_existing(folder: Path) -> None:
    if folder.exists():
        has = "a package" if (folder / FILE_NAME).exists() else "something"
        raise FileFormatError(folder, f"there is {has} already")
