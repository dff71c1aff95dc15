"""Worlds of DynaBARN: cylinders that move through a walled field.

Nair et al., "DynaBARN: Benchmarking Metric Ground Navigation in Dynamic Environments"
(SSRR 2022): 20 m × 20 m, the robot starts outside the open side.
"""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Pose2, Transform3
from navette.sim import Scene, World

START = Pose2(11.0, 0.0, math.pi)
PREFIX = "dynabarn:"
_HALF_M, _WALL_M, _HEIGHT_M = 10.0, 0.5, 1.0


def dynabarn_scene(world: str) -> Scene:
    """Return the world ``dynabarn:FILE:NUMBER``.

    Raises:
        InvalidValueError: the file has no such world.
        FileFormatError: the file has other content.
    """
    file, _, number = world.removeprefix(PREFIX).rpartition(":")
    worlds = obstacles_of(Path(file))
    if not (number.isdigit() and int(number) in worlds):
        raise InvalidValueError(
            f"world {world!r}: {number!r} is not in {file!r}; available: "
            f"{sorted(worlds)}"
        )
    obstacles = worlds[int(number)]
    field = walled_field(f"dynabarn-{number}")
    for index, obstacle in enumerate(obstacles):
        try:
            field.add_actor(
                [tuple(frame) for frame in obstacle["keyframes_t_x_y"]],
                float(obstacle["radius_m"]),
                height=_HEIGHT_M,
            )
        except (TypeError, KeyError, ValueError) as error:
            raise FileFormatError(
                file, f"world_{number}, obstacle {index}: {error!r}; {_EXPECTED}"
            ) from error
    return placed(field.scene())


def walled_field(name: str) -> World:
    """Return the field with walls on three sides; the robot enters from +x."""
    edge = 2 * _HALF_M
    return (
        World(name)
        .add_box((-_HALF_M, 0.0), (_WALL_M, edge), height=_HEIGHT_M)
        .add_box((0.0, _HALF_M), (edge, _WALL_M), height=_HEIGHT_M)
        .add_box((0.0, -_HALF_M), (edge, _WALL_M), height=_HEIGHT_M)
    )


def placed(field: Scene) -> Scene:
    """Return the field with the robot's start."""
    return replace(field, start=Transform3.from_pose2(START))


_EXPECTED = "expected radius_m and keyframes_t_x_y, a list of [s, m, m]"


def obstacles_of(file: Path) -> dict[int, list[dict[str, Any]]]:
    """Return number → obstacles of a file ``trajectories.json``."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise FileFormatError(file, f"not JSON: {error}") from error
    if not isinstance(content, dict):
        raise FileFormatError(file, "expected an object of worlds world_N")
    worlds = {}
    for name, obstacles in content.items():
        match = re.fullmatch(r"world_(\d+)", name)
        if match is None or not isinstance(obstacles, list):
            raise FileFormatError(
                file, f"{name!r}: expected world_N with a list of obstacles"
            )
        worlds[int(match[1])] = obstacles
    return worlds
