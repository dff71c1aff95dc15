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
_FIELD_BYTES = 4
_FIELDS = [
    PointField(name=name, offset=_FIELD_BYTES * k, datatype=PointField.FLOAT32, count=1)
    for k, name in enumerate("xyz")
]


def points_to_message(
    points: NDArray[np.float64], frame_id: str, stamp_ns: int
) -> PointCloud2:
    """Return a cloud of points (N, 2), m, at z = 0."""
    cloud = np.zeros((len(points), 3), np.float32)
    cloud[:, :2] = points
    return PointCloud2(
        header=header(stamp_ns, frame_id),
        height=1,
        width=len(points),
        fields=list(_FIELDS),
        point_step=3 * _FIELD_BYTES,
        row_step=3 * _FIELD_BYTES * len(points),
        data=cloud.reshape(-1).view(np.uint8),
        is_dense=True,
    )


def points_from_message(msg: PointCloud2) -> NDArray[np.float64]:
    """Return the finite points (N, 2) x, y of a cloud.

    Raises:
        InvalidValueError: no x and y of type float32, or data of another size.
    """
    return _points(msg, *_checked_offsets(msg))


def _points(msg: PointCloud2, x: int, y: int) -> NDArray[np.float64]:
    """Return the finite points; x and y are at these offsets in each, bytes."""
    rows = np.asarray(msg.data, np.uint8).view(_row_type(x, y, msg.point_step))
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
def _row_type(x: int, y: int, step: int) -> np.dtype[np.void]:
    """Return the type of a point of ``step`` bytes with x and y at these offsets."""
    return np.dtype(
        {
            "names": ["x", "y"],
            "formats": ["<f4", "<f4"],
            "offsets": [x, y],
            "itemsize": step,
        }
    )


def _checked_offsets(msg: PointCloud2) -> tuple[int, int]:
    """Return the offsets of x and y in a point, bytes."""
    fields = msg.fields
    is_own = len(fields) == len(_FIELDS) and all(map(is_, fields, _FIELDS))
    offsets = _OFFSETS if is_own else _float_offsets(fields)
    count, step = msg.width * msg.height, msg.point_step
    size = len(msg.data)
    x, y = offsets.get("x", step), offsets.get("y", step)
    if max(x, y) + _FIELD_BYTES > step or size != count * step or msg.is_bigendian:
        raise InvalidValueError(
            f"point cloud of {msg.width} x {msg.height} points with fields "
            f"{sorted(offsets)} in {size} bytes: expected float32 x and y, "
            f"little-endian, in {step} bytes a point"
        )
    return x, y


def _float_offsets(fields: list[PointField]) -> dict[str, int]:
    return {
        each.name: each.offset for each in fields if each.datatype == PointField.FLOAT32
    }


_OFFSETS = _float_offsets(_FIELDS)


class HitPoints:
    """The newest clouds by stamp, for the grids of the same stamps."""

    def __init__(self) -> None:
        # Converted on first use: most are not used. Until then with the offsets.
        self._clouds: dict[
            int, tuple[PointCloud2, tuple[int, int]] | NDArray[np.float64]
        ] = {}

    def clear(self) -> None:
        """Drop all clouds."""
        self._clouds.clear()

    def receive(self, msg: PointCloud2) -> int:
        """Store a cloud; return its stamp.

        Raises:
            InvalidValueError: it is invalid; see :func:`points_from_message`.
        """
        offsets = _checked_offsets(msg)
        stamp_ns = stamp_of(msg.header)
        self._clouds.pop(stamp_ns, None)  # of an earlier run: now the newest
        self._clouds[stamp_ns] = msg, offsets
        while len(self._clouds) > _KEPT:
            del self._clouds[next(iter(self._clouds))]
        return stamp_ns

    def at(self, stamp_ns: int) -> NDArray[np.float64] | None:
        """Return the points (N, 2) of the cloud with this stamp, if it arrived."""
        found = self._clouds.get(stamp_ns)
        if found is None or isinstance(found, np.ndarray):
            return found
        msg, offsets = found
        points = self._clouds[stamp_ns] = _points(msg, *offsets)
        return points
