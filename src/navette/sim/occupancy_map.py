# SPDX-License-Identifier: Apache-2.0
"""ROS map_server maps (.yaml with an image) as worlds of wall boxes."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from navette.errors import FileFormatError
from navette.geometry import Pose2, Transform3, quaternion_from_yaw
from navette.sim.scene import Box, Geometry, Link, Model, Plane, Scene
from navette.untrusted.budget import DOCUMENT
from navette.untrusted.files import read_bounded
from navette.untrusted.yaml_input import line_of, load_yaml, problem_of

WALL_HEIGHT_M = 1.0
MAX_PIXELS = 16_000_000
MAX_BOXES = 50_000

_WALL_COLOUR = (0.42, 0.45, 0.50, 1.0)


@dataclass(frozen=True)
class _MapFile:
    image: Path
    resolution: float
    origin: Pose2
    negate: bool
    occupied_threshold: float


def read_map(path: Path) -> Scene:
    """Convert occupied cells to boxes: runs along a row, merged over equal rows.

    Raises:
        FileFormatError: the YAML file or its image is invalid, missing or too large.
    """
    described = _read_yaml(path)
    occupied = _occupied(described, path)
    boxes = merge_runs(occupied)
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


def _read_yaml(path: Path) -> _MapFile:
    try:
        values = load_yaml(read_bounded(path, DOCUMENT))
    except yaml.YAMLError as error:
        reason = f"not YAML: {problem_of(error)}"
        raise FileFormatError(path, reason, line_of(error)) from None
    if not isinstance(values, dict):
        raise FileFormatError(
            path, "a map file must be a mapping with image, resolution, …"
        )
    mode = values.get("mode", "trinary")
    if mode not in ("trinary", "scale", "raw"):
        raise FileFormatError(path, f"mode {mode!r}; known: trinary, scale, raw")
    image = values.get("image")
    if not isinstance(image, str) or not image:
        raise FileFormatError(path, "'image' must name a file")
    origin = values.get("origin", [0.0, 0.0, 0.0])
    if not isinstance(origin, list) or len(origin) != 3:
        raise FileFormatError(path, f"'origin' is {origin!r}; expected [x, y, yaw]")
    x, y, yaw = (_number(path, "origin", value) for value in origin)
    resolution = _number(path, "resolution", values.get("resolution"))
    if resolution <= 0:
        raise FileFormatError(path, f"'resolution' is {resolution:g}; must be > 0 m")
    threshold = _number(path, "occupied_thresh", values.get("occupied_thresh", 0.65))
    free = _number(path, "free_thresh", values.get("free_thresh", 0.0))
    if not 0 <= free < threshold <= 1:
        raise FileFormatError(
            path,
            f"'free_thresh' is {free:g} and 'occupied_thresh' {threshold:g}; "
            "expected 0 <= free_thresh < occupied_thresh <= 1",
        )
    return _MapFile(
        image=path.parent / image,
        resolution=resolution,
        origin=Pose2(x, y, yaw),
        negate=bool(values.get("negate", 0)),
        occupied_threshold=threshold,
    )


def _number(path: Path, key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise FileFormatError(path, f"{key!r} is {value!r}; expected a number")
    if not math.isfinite(value):
        raise FileFormatError(path, f"{key!r} is {value!r}; expected a finite number")
    return float(value)


def _occupied(described: _MapFile, path: Path) -> NDArray[np.bool_]:
    """(H, W), row 0 at the bottom, as grids have it; dark is occupied."""
    try:
        with Image.open(described.image, formats=("PPM", "PNG", "BMP")) as image:
            if image.width * image.height > MAX_PIXELS:
                raise FileFormatError(
                    path,
                    f"image of {image.width} x {image.height} pixels; "
                    f"at most {MAX_PIXELS}",
                )
            grey = np.asarray(image.convert("L"), dtype=np.float64)
    except (OSError, UnidentifiedImageError, Image.DecompressionBombError) as error:
        raise FileFormatError(
            path, f"image {described.image.name!r} cannot be read: {error}"
        ) from None
    share = grey / 255.0 if described.negate else 1.0 - grey / 255.0
    occupied: NDArray[np.bool_] = np.flipud(share > described.occupied_threshold)
    return occupied
