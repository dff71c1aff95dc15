"""Trials in the worlds of DynaBARN: cylinders that move through a walled field.

Nair et al., "DynaBARN: Benchmarking Metric Ground Navigation in Dynamic Environments"
(SSRR 2022): 20 m × 20 m, the robot starts outside the open side and drives 20 m across.
Success, time limit and score are those of the BARN challenge, whose runner drives these
worlds too; the shortest path is the straight line.
"""

import json
import math
import re
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Pose2
from navette.navigation.bench.trial import Trial
from navette.sim import Scene, World

START = Pose2(11.0, 0.0, math.pi)
GOAL = (-9.0, 0.0)
FILE = "trajectories.json"
_HALF_M, _WALL_M, _HEIGHT_M = 10.0, 0.5, 1.0
_PREFIX = "dynabarn:"


def dynabarn_trials(folder: Path, numbers: tuple[int, ...] = ()) -> list[Trial]:
    """Return a trial for each world of ``trajectories.json``, or for the given numbers.

    Raises:
        InvalidValueError: a missing file or world.
        FileFormatError: the file has other content.
    """
    file = folder / FILE
    if not file.is_file():
        raise InvalidValueError(f"folder {str(folder)!r}: expected {FILE}")
    found = sorted(_worlds(file))
    missing = [number for number in numbers if number not in found]
    if missing:
        raise InvalidValueError(
            f"worlds {missing}: not in {str(file)!r}; available: {found}"
        )
    return [
        dynabarn_trial("dynabarn", f"world_{number}", f"{_PREFIX}{file}:{number}")
        for number in numbers or found
    ]


def dynabarn_trial(suite: str, name: str, world: str) -> Trial:
    """Return the drive across a world of this kind."""
    return Trial(
        suite=suite,
        name=name,
        world=world,
        robot="jackal",
        start=START,
        goals=(GOAL,),
        reach_m=1.0,
        ends_at_contact=True,
        limit_s=100.0,
        shortest_m=math.dist(START[:2], GOAL),
    )


def dynabarn_scene(world: str) -> Scene | None:
    """Return the scene of ``dynabarn:FILE:NUMBER``; None for another world."""
    if not world.startswith(_PREFIX):
        return None
    file, _, number = world.removeprefix(_PREFIX).rpartition(":")
    obstacles = _worlds(Path(file))[int(number)]
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
    return field.scene()


def walled_field(name: str) -> World:
    """Return the field with walls on three sides; the robot enters from +x."""
    edge = 2 * _HALF_M
    return (
        World(name)
        .add_box((-_HALF_M, 0.0), (_WALL_M, edge), height=_HEIGHT_M)
        .add_box((0.0, _HALF_M), (edge, _WALL_M), height=_HEIGHT_M)
        .add_box((0.0, -_HALF_M), (edge, _WALL_M), height=_HEIGHT_M)
    )


_EXPECTED = "expected radius_m and keyframes_t_x_y, a list of [s, m, m]"


def _worlds(file: Path) -> dict[int, list[dict[str, Any]]]:
    """Return number → obstacles of the file."""
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
