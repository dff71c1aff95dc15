"""Trials in the worlds of the BARN challenge.

The folder contains ``worlds/world_N.world`` and ``paths/path_N.npy``, as published on
https://www.cs.utexas.edu/~xiao/BARN/BARN.html.
"""

import itertools
import math
import re
from pathlib import Path

import numpy as np

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.bench.trial import Trial

START = Pose2(-2.25, 3.0, 1.57)
GOAL = (-2.25, 13.0)
_CELL_M = 0.15
_ORIGIN = (-4.575, 5.075)  # centre of cell (0, 0) of the reference paths


def barn_trials(folder: Path, numbers: tuple[int, ...] = ()) -> list[Trial]:
    """Return a trial for each world of the folder, or for the given numbers.

    Raises:
        InvalidValueError: a missing world or path, or no worlds.
    """
    found = {
        int(match[1]): path
        for path in folder.glob("worlds/world_*.world")
        if (match := re.fullmatch(r"world_(\d+)", path.stem))
    }
    if not found:
        raise InvalidValueError(
            f"folder {str(folder)!r}: expected worlds/world_N.world and "
            "paths/path_N.npy"
        )
    missing = [number for number in numbers if number not in found]
    if missing:
        raise InvalidValueError(
            f"worlds {missing}: not in {str(folder)!r}; available: {sorted(found)}"
        )
    return [
        Trial(
            suite="barn",
            name=f"world_{number}",
            world=str(found[number]),
            robot="jackal",
            start=START,
            goals=(GOAL,),
            reach_m=1.0,
            limit_s=100.0,
            shortest_m=reference_length(folder / f"paths/path_{number}.npy"),
        )
        for number in numbers or sorted(found)
    ]


def reference_length(file: Path) -> float:
    """Return the length (m) of a reference path: start, its cells, goal.

    Raises:
        InvalidValueError: not an array (N, 2) of cells.
    """
    try:
        cells = np.load(file, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise InvalidValueError(f"reference path {str(file)!r}: {error}") from error
    if cells.ndim != 2 or cells.shape[1] != 2:
        raise InvalidValueError(
            f"reference path {str(file)!r}: shape {cells.shape}, expected (N, 2)"
        )
    points = [(START.x, START.y), *(cells * _CELL_M + _ORIGIN).tolist(), GOAL]
    return sum(math.dist(a, b) for a, b in itertools.pairwise(points))
