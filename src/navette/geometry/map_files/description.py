"""The YAML file of a map: image, resolution, origin, thresholds, mode."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError, instead_of
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.files.untrusted.yaml_input import line_of, load_yaml, problem_of
from navette.geometry import Pose2

MAP_MODES = ("trinary", "scale", "raw")
# Those of ROS's map_server and Nav2's.
_NEEDED = ("image", "resolution")
_KEYS = (*_NEEDED, "origin", "negate", "free_thresh", "occupied_thresh", "mode")
# Of map_server, for files without them.
_OCCUPIED, _FREE = 0.65, 0.196


@dataclass(frozen=True)
class MapDescription:
    """Contents of the YAML file; see https://wiki.ros.org/map_server."""

    path: Path
    image: Path
    resolution: float
    origin: Pose2
    negate: bool
    free_threshold: float
    occupied_threshold: float
    mode: str


def read_description(path: Path) -> MapDescription:
    """Read the YAML file of a map.

    Raises:
        FileFormatError: missing, not YAML, or a value is invalid; names line or key.
    """
    values = _mapping(path)
    mode = values.get("mode", "trinary")
    if mode not in MAP_MODES:
        raise FileFormatError(path, f"mode {mode!r}; known: {', '.join(MAP_MODES)}")
    image = values["image"]
    if not isinstance(image, str) or not image:
        raise FileFormatError(path, "'image' must name a file")
    file = Path(image)
    origin = values.get("origin", [0.0, 0.0, 0.0])
    if not isinstance(origin, list) or len(origin) != 3:
        raise FileFormatError(path, f"'origin' is {origin!r}; expected [x, y, yaw]")
    x, y, yaw = (_number(path, "origin", value) for value in origin)
    resolution = _number(path, "resolution", values["resolution"])
    if resolution <= 0:
        raise FileFormatError(path, f"'resolution' is {resolution:g}; must be > 0 m")
    occupied = _number(
        path, "occupied_thresh", values.get("occupied_thresh", _OCCUPIED)
    )
    usual_free = _FREE if occupied > _FREE else 0.0
    free = _number(path, "free_thresh", values.get("free_thresh", usual_free))
    if not 0 <= free < occupied <= 1:
        raise FileFormatError(
            path,
            f"'free_thresh' is {free:g} and 'occupied_thresh' {occupied:g}; "
            "expected 0 <= free_thresh < occupied_thresh <= 1",
        )
    return MapDescription(
        path=path,
        image=path.parent / (file.expanduser() if image.startswith("~/") else file),
        resolution=resolution,
        origin=Pose2(x, y, yaw),
        negate=_flag(path, "negate", values.get("negate", 0)),
        free_threshold=free,
        occupied_threshold=occupied,
        mode=mode,
    )


def _mapping(path: Path) -> dict[Any, Any]:
    try:
        values = load_yaml(read_bounded(path, DOCUMENT))
    except yaml.YAMLError as error:
        reason = f"not YAML: {problem_of(error)}"
        raise FileFormatError(path, reason, line_of(error)) from None
    if not isinstance(values, dict):
        raise FileFormatError(
            path, "a map file must be a mapping with image, resolution, …"
        )
    _check_keys(path, values)
    return values


def _check_keys(path: Path, values: dict[Any, Any]) -> None:
    """Check that no key is missing, and that none would have no effect."""
    for key in map(str, values):
        if key not in _KEYS:
            hint = instead_of(key, _KEYS, see_all="wiki.ros.org/map_server")
            raise FileFormatError(path, f"unknown key {key!r}{hint}")
    for key in _NEEDED:
        if key not in values:
            raise FileFormatError(path, f"{key!r} is missing")


def _flag(path: Path, key: str, value: Any) -> bool:
    if value not in (0, 1):  # True and False are equal to these
        raise FileFormatError(path, f"{key!r} is {value!r}; expected 0 or 1")
    return bool(value)


def _number(path: Path, key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise FileFormatError(path, f"{key!r} is {value!r}; expected a number")
    if not math.isfinite(value):
        raise FileFormatError(path, f"{key!r} is {value!r}; expected a finite number")
    return float(value)
