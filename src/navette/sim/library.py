# SPDX-License-Identifier: Apache-2.0
"""Worlds and robots by name (built in) or by file."""

from dataclasses import dataclass, field, replace
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import yaml

from navette.errors import (
    FileFormatError,
    InvalidValueError,
    ParameterError,
    UnknownNameError,
)
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.files.untrusted.yaml_input import load_yaml
from navette.params.plugins import load_attribute
from navette.sim.mjcf import read_mjcf
from navette.sim.mounting import with_sensors
from navette.sim.occupancy_map import read_map
from navette.sim.robot_file import RobotFile, model_of, read_robot_file
from navette.sim.scene import Model, Scene
from navette.sim.sdf import read_sdf
from navette.sim.urdf import read_urdf_robot, read_urdf_world

ROBOTS = "navette.robots"
"""Group of the entry points of robots."""

_DATA = Path(__file__).parent / "data"
_WORLDS = _DATA / "worlds"
_ROBOTS = _DATA / "robots"

_SHORT_NAMES = {"burger": "turtlebot3_burger"}

_WORLD_READERS = {
    ".sdf": read_sdf,
    ".world": read_sdf,
    ".urdf": read_urdf_world,
    ".xml": read_mjcf,
    ".yaml": read_map,
    ".yml": read_map,
}


@dataclass(frozen=True)
class Robot:
    """A robot and the parameter file of all nodes for it, or None.

    A built-in robot has one; a model file has one if ``params.yaml`` is beside it.
    """

    name: str
    model: Model
    params_file: Path | None = None
    #: Names of its topics, by the stack's names for them; ``names.yaml`` beside it.
    topic_names: dict[str, str] = field(default_factory=dict)
    #: Node → parameter → value, before those of the file.
    parameters: dict[str, dict[str, Any]] = field(default_factory=dict)


def world_names() -> list[str]:
    return sorted(path.stem for path in _WORLDS.glob("*.sdf"))


def robot_names() -> list[str]:
    return sorted(path.parent.name for path in _ROBOTS.glob("*/model.sdf"))


def load_world(name_or_path: str | Path) -> Scene:
    """Load a built-in world by name, or a .sdf, .world, .urdf, .xml or .yaml file.

    Raises:
        UnknownNameError: neither a built-in name nor a file; lists the names.
        FileFormatError: the file has an unknown extension or is invalid.
    """
    if str(name_or_path) in world_names():
        return replace(
            read_sdf(_WORLDS / f"{name_or_path}.sdf"), name=str(name_or_path)
        )
    path = _existing(name_or_path, "world", world_names())
    reader = _WORLD_READERS.get(path.suffix.lower())
    if reader is None:
        kinds = ", ".join(_WORLD_READERS)
        raise FileFormatError(
            path, f"unknown extension of a world file; known: {kinds}"
        )
    return reader(path)


def load_robot(name_or_path: str | Path) -> Robot:
    """Load a robot by name, or the one in an .sdf, .urdf or .yaml file.

    A name is that of a built-in robot, or of an entry point ``navette.robots`` of an
    installed package: its file, or a function that returns it. ``jackal:ros1`` is the
    built-in robot with the topic names of ``names_ros1.yaml``.

    Raises:
        UnknownNameError: neither a built-in name nor a file; lists the names.
        FileFormatError: the file is invalid or has no model with a drive.
    """
    name, colon, variant = str(name_or_path).partition(":")
    name = _SHORT_NAMES.get(name, name)
    if name in robot_names():
        folder = _ROBOTS / name
        model = _driven(read_sdf(folder / "model.sdf"), folder / "model.sdf")
        names = folder / "names.yaml"
        if colon:
            variants = sorted(each.stem[6:] for each in folder.glob("names_*.yaml"))
            if variant not in variants:
                raise UnknownNameError.of(f"topic names of {name}", variant, variants)
            names = folder / f"names_{variant}.yaml"
        return Robot(name, model, folder / "params.yaml", _topic_names(names))
    name += colon + variant
    installed = _installed_robot(name)
    if installed is not None:
        return replace(load_robot(installed), name=name)
    known = [*robot_names(), *(each.name for each in entry_points(group=ROBOTS))]
    path = _existing(name_or_path, "robot", known)
    if path.suffix.lower() in (".yaml", ".yml"):
        return _described_robot(path)
    beside = path.parent / "params.yaml"
    params_file = beside if beside.is_file() else None
    topic_names = _topic_names(path.parent / "names.yaml")
    if path.suffix.lower() == ".urdf":
        model = read_urdf_robot(path)
        return Robot(model.name, model, params_file, topic_names)
    if path.suffix.lower() in (".sdf", ".world"):
        model = _driven(read_sdf(path), path)
        return Robot(model.name, model, params_file, topic_names)
    raise FileFormatError(
        path, "unknown extension of a robot file; known: .sdf, .urdf, .yaml"
    )


def _described_robot(path: Path) -> Robot:
    """Return the robot of a YAML file with sizes, or with the name of a model file."""
    file = read_robot_file(path)
    if file.sizes is not None:
        model = _equipped(path, model_of(file.sizes), file)
        return Robot(
            model.name,
            model,
            None,
            _topic_names(path.parent / "names.yaml"),
            file.parameters,
        )
    assert file.model is not None, "a robot's file has sizes or a model"
    if not file.model.is_file():
        raise FileFormatError(path, f"model: {file.model}: no such file")
    robot = load_robot(file.model)
    model = _equipped(path, robot.model, file)
    return replace(robot, model=model, parameters=file.parameters)


def _equipped(path: Path, model: Model, file: RobotFile) -> Model:
    try:
        return with_sensors(model, file.sensors.items())
    except ParameterError as error:
        raise FileFormatError(path, str(error)) from None


def _installed_robot(name: str) -> Path | None:
    """Return the file of a robot of an installed package.

    Raises:
        InvalidValueError: the entry point is not a file or a function that returns one.
    """
    for point in entry_points(group=ROBOTS, name=name):
        found = load_attribute(point.value)
        found = found() if callable(found) else found
        if not isinstance(found, str | Path):
            raise InvalidValueError(
                f"entry point {ROBOTS} {name!r} ({point.value}): expected the path of "
                f"a model, or a function that returns it, not {found!r}"
            )
        return Path(found)
    return None


def _topic_names(path: Path) -> dict[str, str]:
    """Read a robot's topic names by those of the stack; empty without the file.

    Raises:
        FileFormatError: the file is not a map from topic names to topic names.
    """
    if not path.is_file():
        return {}
    try:
        names = load_yaml(read_bounded(path, DOCUMENT))
    except yaml.YAMLError as error:
        raise FileFormatError(path, f"not YAML: {error}") from None
    if not isinstance(names, dict) or not all(
        isinstance(each, str) and each.startswith("/")
        for pair in names.items()
        for each in pair
    ):
        raise FileFormatError(
            path, "expected lines '/name_of_the_stack: /name_of_the_robot'"
        )
    return names


def identify_robot(model: Model) -> Robot | None:
    """Return the built-in robot with the name and the wheels of ``model``, or None.

    A world with its own copy of a built-in robot gets that robot's parameters.
    """
    for name in robot_names():
        known = load_robot(name)
        if known.model.name == model.name and _same_drive(known.model, model):
            return replace(known, model=model)
    return None


def _same_drive(a: Model, b: Model) -> bool:
    if a.drive is None or b.drive is None:
        return False
    pairs = (
        (a.drive.wheel_radius, b.drive.wheel_radius),
        (a.drive.wheel_separation, b.drive.wheel_separation),
    )
    return all(abs(p - q) <= 0.02 * p for p, q in pairs)


def _driven(scene: Scene, path: Path) -> Model:
    if scene.robot is None:
        raise FileFormatError(path, "the file has no model with a differential drive")
    return scene.robot


def _existing(name_or_path: str | Path, kind: str, known: list[str]) -> Path:
    path = Path(name_or_path)
    if not path.is_file():
        raise UnknownNameError.of(f"{kind} or file", str(path), known)
    return path
