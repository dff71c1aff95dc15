"""Creation of packages from templates.

The text of a template may contain ``$package``, ``$node``, …, and its file name
``{package}``, …: see ``_values``.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from string import Template

from navette.errors import FileFormatError, InvalidNameError
from navette.files.writing import writing
from navette.ros2.workspace.manifest import FILE_NAME

TEMPLATES = Path(__file__).parent / "templates"
_SUFFIX = ".template"  # so that tools do not process templates as source files
_NAME = re.compile(r"[a-z](?:_?[a-z0-9]+)+")
_NODE_NAME = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*")
_DEPENDENCY_NAME = re.compile(r"[a-zA-Z0-9][\w-]+", re.ASCII)
_MESSAGES = "_msgs"
#: Dependencies that the templates contain.
_PYTHON_NEEDS = ("launch", "launch_ros", "rclpy", "std_msgs", "ament_index_python")
_MESSAGES_NEEDS = ("std_msgs", "builtin_interfaces", "action_msgs")


#: Build types of ROS 2's own packages without contents.
BUILD_TYPES = ("ament_python", "ament_cmake")


@dataclass(frozen=True, slots=True)
class PackageAbout:
    """Texts of a manifest; the defaults are ROS 2's."""

    description: str = "TODO: Package description"
    license: str = "TODO: License declaration"
    maintainer: str = "user"
    email: str = "user@todo.todo"


def create_bare_package(
    name: str,
    folder: Path,
    build_type: str,
    *,
    node: str | None = None,
    dependencies: Sequence[str] = (),
    about: PackageAbout | None = None,
) -> Path:
    """Create the package of ``ros2 pkg create --build-type``: build files, no contents.

    Args:
        build_type: ``ament_python`` or ``ament_cmake``.
        node: name of a program that prints a line; default: none.

    Raises:
        InvalidNameError: ROS 2 does not allow a name, or unknown build type.
        FileFormatError: the folder exists already.
    """
    _check(name, _NAME, "package", "a-z, then a-z, 0-9 and single underscores")
    for each in dependencies:
        _check(each, _DEPENDENCY_NAME, "package", "a-z, A-Z, 0-9, hyphens, underscores")
    if build_type not in BUILD_TYPES:
        raise InvalidNameError(
            f"{build_type!r} is not a build type; allowed: {', '.join(BUILD_TYPES)}"
        )
    if node is not None:
        _check(node, _NODE_NAME, "node", "a-z or A-Z, then also 0-9 and underscores")
    values = _values(name, node or name, dependencies) | _about_values(about)
    values |= {"entry_points": "", "cmake_program": ""}
    if node is not None:
        entry = f"'{node} = {name}.{node}:main',"
        values["entry_points"] = f"\n            {entry}"
        values["cmake_program"] = (
            f"\nadd_executable({node} src/{node}.cpp)\n"
            f"install(TARGETS {node}\n  DESTINATION lib/${{PROJECT_NAME}})\n"
        )
    package = _make(build_type, folder / name, values)
    if node is not None:
        _fill(f"{build_type}_node", package, values)
    return package


def _about_values(about: PackageAbout | None) -> dict[str, str]:
    """Return the texts as XML and as Python literals."""
    about = about or PackageAbout()
    texts = {
        "description": about.description,
        "license": about.license,
        "maintainer": about.maintainer,
        "email": about.email,
    }
    as_xml = {key: escape(text) for key, text in texts.items()}
    return as_xml | {f"{key}_literal": repr(text) for key, text in texts.items()}


def create_package(
    name: str,
    folder: Path,
    *,
    node: str | None = None,
    messages: bool = False,
    dependencies: Sequence[str] = (),
) -> list[Path]:
    """Create a package below ``folder`` and return the folders of the new packages.

    A package whose name ends in ``_msgs`` has messages, services and actions; every
    other package has a node.

    Args:
        node: name of the node; default: the package's name.
        messages: also create a package ``<name>_msgs`` and depend on it.
        dependencies: further packages to depend on.

    Raises:
        InvalidNameError: ROS 2 does not allow a name.
        FileFormatError: the folder exists already.
    """
    _check(name, _NAME, "package", "a-z, then a-z, 0-9 and single underscores")
    for each in dependencies:
        _check(each, _DEPENDENCY_NAME, "package", "a-z, A-Z, 0-9, hyphens, underscores")
    if name.endswith(_MESSAGES):
        if node is not None:
            raise InvalidNameError(
                f"{name!r} is a package of messages ({_MESSAGES}), which has no node"
            )
        needs = [each for each in dependencies if each not in _MESSAGES_NEEDS]
        return [_make("messages", folder / name, _values(name, name, needs))]
    node = node or name
    _check(node, _NODE_NAME, "node", "a-z or A-Z, then also 0-9 and underscores")
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
            f"{name!r} is not a valid {kind} name; allowed: {allowed}"
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
    return _fill(template, folder, values)


def _fill(template: str, folder: Path, values: dict[str, str]) -> Path:
    root = TEMPLATES / template
    for source in sorted(root.rglob(f"*{_SUFFIX}")):
        relative = str(source.relative_to(root)).removesuffix(_SUFFIX)
        target = folder / relative.format_map(values)
        text = Template(source.read_text(encoding="utf-8")).substitute(values)
        with writing(target):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
    return folder


def _refuse_existing(folder: Path) -> None:
    if folder.exists():
        kind = "package" if (folder / FILE_NAME).exists() else "file or folder"
        raise FileFormatError(folder, f"this {kind} exists already")
