"""Programs of a package, read from its build files without running these.

The parsers of build files are imported on first use: ``navette run FILE.py`` searches
packages, but reads the programs of none.
"""

import ast
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from navette.errors import FileFormatError
from navette.ros2.workspace.setup_py import read_setup_py

BUILT_IN = "navette"
_STAGES = (
    "sim",
    "odom_integrator",
    "ekf",
    "localization",
    "localizer",
    "amcl",
    "slam",
    "costmap",
    "map_memory",
    "tracking",
    "zones",
    "reflex",
    "planner",
    "control",
    "behaviors",
    "arbiter",
    "missions",
    "explorer",
    "lifecycle_manager",
    "viewer",
    "recorder",
)
#: ROS 2's windows, which the live view replaces.
_WINDOWS = ("rviz2", "rqt_graph", "rqt_console", "rqt_gui")
_TURTLES = ("turtlesim_node", "turtle_teleop_key", "draw_square", "mimic")
_TRANSFORMS = ("static_transform_publisher", "tf2_echo")
#: Package → program → module and function.
_PROGRAMS = {
    BUILT_IN: {
        "component_container": ("navette.ros2.launch.container", "main"),
        **{name: ("navette.navigation.stack.stages", name) for name in _STAGES},
    },
    "turtlesim": {name: ("navette.cli.turtlesim", name) for name in _TURTLES},
    "tf2_ros": {name: ("navette.cli.tf2_programs", name) for name in _TRANSFORMS},
    **{name: {name: ("navette.cli.live_view", "main")} for name in _WINDOWS},
}
PACKAGES_OF_PROGRAMS = frozenset(_PROGRAMS)

_ENTRY_POINT = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*(\w+)\s*")
_CMAKE_PROGRAMS = re.compile(
    r"\binstall\s*\(\s*PROGRAMS\s+(.*?)\s+DESTINATION", re.DOTALL | re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class PackageExecutable:
    """A program: a function (``module`` and ``attribute``) or a file (``path``)."""

    package: str
    name: str
    module: str = ""
    attribute: str = ""
    path: Path | None = None


def built_in_executables(package: str) -> tuple[PackageExecutable, ...]:
    """Return Navette's programs: the stages, the component container, turtlesim."""
    return tuple(
        PackageExecutable(package, name, module, attribute)
        for name, (module, attribute) in sorted(_PROGRAMS.get(package, {}).items())
    )


def source_executables(package: str, folder: Path) -> tuple[PackageExecutable, ...]:
    """Return the entry points of a source package and the programs CMake installs."""
    texts = [
        *_from_setup_py(folder / "setup.py"),
        *_from_setup_cfg(folder / "setup.cfg"),
        *_from_pyproject(folder / "pyproject.toml"),
    ]
    found = {}
    for text in texts:
        match = _ENTRY_POINT.fullmatch(text)
        if match:
            name, module, attribute = match.groups()
            found[name] = PackageExecutable(package, name, module, attribute)
    for path in _from_cmake(folder / "CMakeLists.txt"):
        found[path.name] = PackageExecutable(package, path.name, path=path)
    return tuple(found[name] for name in sorted(found))


def installed_executables(package: str, folder: Path) -> tuple[PackageExecutable, ...]:
    """Return the executable files of ``lib/<package>`` below a prefix."""
    if not folder.is_dir():
        return ()
    return tuple(
        PackageExecutable(package, path.name, path=path)
        for path in sorted(folder.iterdir())
        if path.is_file() and os.access(path, os.X_OK)
    )


def _from_pyproject(path: Path) -> Iterator[str]:
    if not path.is_file():
        return
    import tomllib

    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise FileFormatError(path, str(error)) from None
    for name, target in content.get("project", {}).get("scripts", {}).items():
        yield f"{name} = {target}"


def _from_setup_cfg(path: Path) -> Iterator[str]:
    if not path.is_file():
        return
    import configparser

    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(path.read_text(encoding="utf-8"))
    except configparser.Error as error:
        raise FileFormatError(path, str(error)) from None
    lines = parser.get("options.entry_points", "console_scripts", fallback="")
    yield from lines.splitlines()


def _from_cmake(path: Path) -> Iterator[Path]:
    if not path.is_file():
        return
    text = re.sub(r"#.*", "", path.read_text(encoding="utf-8"))
    for listed in _CMAKE_PROGRAMS.findall(text):
        files = (path.parent / name.strip('"') for name in listed.split())
        yield from (file for file in files if file.is_file())


def _from_setup_py(path: Path) -> Iterator[str]:
    setup = read_setup_py(path)
    entry_points = setup and setup.arguments.get("entry_points")
    if not setup or not isinstance(entry_points, ast.Dict):
        return
    for key, value in zip(entry_points.keys, entry_points.values, strict=True):
        if key is not None and setup.text(key) == "console_scripts":
            yield from setup.texts(value)
