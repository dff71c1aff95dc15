"""Points at which beams ended, as messages beside the grid of the same stamp."""

import functools
import math
from operator import is_
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.geometry.messages import header, stamp_of
from navette.msgs.sensor_msgs.msg import PointCloud2, PointField

_KEPT = 16
_TYPES = {PointField.FLOAT32: np.float32, PointField.FLOAT64: np.float64}
# Coordinates above this, such as UTM's, are sent as float64: as float32 they would be
# wrong by up to half a metre. Others are float32, which every viewer reads.
_MOST_FLOAT32_M = 4096.0


def _fields(kind: int) -> list[PointField]:
    size = np.dtype(_TYPES[kind]).itemsize
    return [
        PointField(name=name, offset=size * k, datatype=kind, count=1)
        for k, name in enumerate("xyz")
    ]


_FIELDS = {kind: _fields(kind) for kind in _TYPES}


def points_to_message(
    points: NDArray[np.float64], frame_id: str, stamp_ns: int
) -> PointCloud2:
    """Return a cloud of points (N, 2), m, at z = 0."""
    kind = PointField.FLOAT64 if _are_far(points) else PointField.FLOAT32
    cloud = np.zeros((len(points), 3), _TYPES[kind])
    cloud[:, :2] = points
    return PointCloud2(
        header=header(stamp_ns, frame_id),
        height=1,
        width=len(points),
        fields=list(_FIELDS[kind]),
        point_step=3 * cloud.itemsize,
        row_step=cloud.nbytes,
        data=cloud.reshape(-1).view(np.uint8),
        is_dense=True,
    )


@kernel(allocates=False)
def _are_far(points: Any) -> bool:
    """Return whether any of points (N, 2) has a coordinate too large for float32."""
    largest = 0.0
    for k in range(points.shape[0]):
        largest = max(largest, abs(points[k, 0]), abs(points[k, 1]))
    return largest > _MOST_FLOAT32_M


def points_from_message(msg: PointCloud2) -> NDArray[np.float64]:
    """Return the finite points (N, 2) x, y of a cloud.

    Raises:
        InvalidValueError: no x and y of type float32 or float64, or data of another
            size.
    """
    return _points(msg, _row_type_of(msg))


def _points(msg: PointCloud2, row: np.dtype[np.void]) -> NDArray[np.float64]:
    """Return the finite points of rows of this type."""
    rows = np.asarray(msg.data, np.uint8).view(row)
    points = np.empty((len(rows), 2))
    points[:, 0], points[:, 1] = rows["x"], rows["y"]
    return points[: _move_finite(points)]


@kernel(allocates=False)
def _move_finite(points: Any) -> int:
    """Move the finite points (N, 2) to the front; return how many they are."""
    count = 0
    for k in range(points.shape[0]):
        x, y = points[k, 0], points[k, 1]
        points[count, 0], points[count, 1] = x, y
        count += math.isfinite(x) and math.isfinite(y)
    return count


@functools.lru_cache(maxsize=16)
def _row_type(x: int, y: int, kind: int, step: int) -> np.dtype[np.void]:
    """Return the type of a point of ``step`` bytes with x and y at these offsets."""
    number = np.dtype(_TYPES[kind]).newbyteorder("<")
    return np.dtype(
        {
            "names": ["x", "y"],
            "formats": [number, number],
            "offsets": [x, y],
            "itemsize": step,
        }
    )


def _row_type_of(msg: PointCloud2) -> np.dtype[np.void]:
    """Return the type of the points of a cloud, of which x and y are read."""
    kind, offsets = _kind_and_offsets(msg.fields)
    count, step, size = msg.width * msg.height, msg.point_step, len(msg.data)
    if kind in _TYPES and {"x", "y"} <= offsets.keys() and not msg.is_bigendian:
        end = max(offsets["x"], offsets["y"]) + np.dtype(_TYPES[kind]).itemsize
        if end <= step and size == count * step:
            step = step if count else end  # of no points it may be any number
            return _row_type(offsets["x"], offsets["y"], kind, step)
    raise InvalidValueError(
        f"point cloud of {msg.width} x {msg.height} points with fields "
        f"{sorted(offsets)} in {size} bytes: expected x and y, both float32 or "
        f"float64, little-endian, in {step} bytes a point"
    )


def _kind_and_offsets(fields: list[PointField]) -> tuple[int, dict[str, int]]:
    """Return the type of x, and the offsets of all fields of that type."""
    for kind, own in _FIELDS.items():
        if len(fields) == len(own) and all(map(is_, fields, own)):
            return kind, _OFFSETS[kind]
    kind = next((each.datatype for each in fields if each.name == "x"), 0)
    return kind, _offsets(fields, kind)


def _offsets(fields: list[PointField], kind: int) -> dict[str, int]:
    return {each.name: each.offset for each in fields if each.datatype == kind}


_OFFSETS = {kind: _offsets(fields, kind) for kind, fields in _FIELDS.items()}


class HitPoints:
    """The newest clouds by stamp, for the grids of the same stamps."""

    def __init__(self) -> None:
        # Converted on first use: most are not used. Until then with their type.
        self._clouds: dict[
            int, tuple[PointCloud2, np.dtype[np.void]] | NDArray[np.float64]
        ] = {}

    def clear(self) -> None:
        """Drop all clouds."""
        self._clouds.clear()

    def receive(self, msg: PointCloud2) -> int:
        """Store a cloud; return its stamp.

        Raises:
            InvalidValueError: it is invalid; see :func:`points_from_message`.
        """
        row = _row_type_of(msg)
        stamp_ns = stamp_of(msg.header)
        self._clouds.pop(stamp_ns, None)  # of an earlier run: now the newest
        self._clouds[stamp_ns] = msg, row
        while len(self._clouds) > _KEPT:
            del self._clouds[next(iter(self._clouds))]
        return stamp_ns

    def at(self, stamp_ns: int) -> NDArray[np.float64] | None:
        """Return the points (N, 2) of the cloud with this stamp, if it arrived."""
        found = self._clouds.get(stamp_ns)
        if found is None or isinstance(found, np.ndarray):
            return found
        points = self._clouds[stamp_ns] = _points(*found)
        return points
