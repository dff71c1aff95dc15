# SPDX-License-Identifier: Apache-2.0
"""ROS map_server maps (.yaml with an image) as worlds of wall boxes."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from navette.errors import FileFormatError
from navette.geometry import Transform3, quaternion_from_yaw
from navette.geometry.map_files import read_cells, read_description
from navette.sim.scene import Box, Geometry, Link, Model, Plane, Scene

WALL_HEIGHT_M = 1.0
MAX_BOXES = 50_000

_WALL_COLOUR = (0.42, 0.45, 0.50, 1.0)


def read_map(path: Path) -> Scene:
    """Convert occupied cells to boxes: runs along a row, merged over equal rows.

    Raises:
        FileFormatError: the YAML file or its image is invalid, missing or too large.
    """
    described = read_description(path)
    lethal = 100 * (described.occupied_threshold if described.mode == "raw" else 1.0)
    boxes = merge_runs(read_cells(described) >= lethal)
    if len(boxes) > MAX_BOXES:
        raise FileFormatError(path, f"{len(boxes)} wall boxes; at most {MAX_BOXES}")
    origin, cell = described.origin, described.resolution
    geometries = []
    for i, (row, column, rows, columns) in enumerate(boxes):
        centre = np.array([[column + columns / 2, row + rows / 2]]) * cell
        x, y = origin.apply(centre)[0].tolist()
        pose = Transform3((x, y, WALL_HEIGHT_M / 2), quaternion_from_yaw(origin.yaw))
        size = (columns * cell, rows * cell, WALL_HEIGHT_M)
        geometries.append(
            Geometry(
                name=f"wall {i}",
                shape=Box(size),
                link_T_shape=pose,
                colour=_WALL_COLOUR,
            )
        )
    ground = Link(name="ground", geometries=(Geometry(name="plane", shape=Plane()),))
    walls = Link(name="walls", geometries=tuple(geometries))
    return Scene(
        name=path.stem,
        models=(Model(name="map", static=True, links=(ground, walls)),),
    )


def merge_runs(occupied: NDArray[np.bool_]) -> list[tuple[int, int, int, int]]:
    """Cover the true cells of (H, W) by rectangles (row, column, rows, columns).

    Every true cell is covered once. Runs of a row that continue with the same
    ends in the next row grow the rectangle.
    """
    found: list[tuple[int, int, int, int]] = []
    open_runs: dict[tuple[int, int], int] = {}  # (start, end) → first row
    height = occupied.shape[0]
    for row in range(height + 1):
        runs = set(_runs(occupied[row])) if row < height else set()
        for run in [r for r in open_runs if r not in runs]:
            first = open_runs.pop(run)
            found.append((first, run[0], row - first, run[1] - run[0]))
        for run in runs:
            open_runs.setdefault(run, row)
    return sorted(found)


def _runs(row: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Half-open intervals of true cells."""
    padded = np.concatenate(([False], row, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1]).tolist()
    return list(zip(edges[0::2], edges[1::2], strict=True))
