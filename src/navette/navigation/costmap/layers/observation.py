"""What a sensor observed, as points: hits, and ends of rays without a hit."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidInputError
from navette.geometry import Transform3
from navette.geometry.se3 import rotation_matrix
from navette.msgs.sensor_msgs.msg import LaserScan, PointCloud2, PointField, Range

Points = NDArray[np.float64]

_FORMATS = {PointField.FLOAT32: "f4", PointField.FLOAT64: "f8"}
_MOST_POINTS = 4_000_000
_LARGEST_RAD = 100.0
_FARTHEST_M = 1e4  # no sensor of a robot measures farther


@dataclass(frozen=True, eq=False)
class Observation:
    """Points of one message, in one frame.

    Attributes:
        origin: (3,) of the sensor, m.
        hits: (N, 3) where rays ended on a surface, m.
        misses: (M, 3) ends of rays without a hit, m.
    """

    origin: Points
    hits: Points
    misses: Points

    def placed(self, outer_T_inner: Transform3) -> "Observation":
        """Return the observation in an outer frame."""
        rotation = rotation_matrix(outer_T_inner.rotation)
        offset = np.array(outer_T_inner.translation)
        return Observation(
            rotation @ self.origin + offset,
            self.hits @ rotation.T + offset,
            self.misses @ rotation.T + offset,
        )


class Cone(NamedTuple):
    """A range reading; ``is_free``: nothing was found up to it."""

    reading: float
    half_angle: float
    is_free: bool


_NOTHING = np.empty((0, 3))
_HERE = np.zeros(3)


def of_scan(msg: LaserScan, *, inf_is_valid: bool) -> Observation:
    """Return the observation of a planar scan, in the sensor's frame."""
    with np.errstate(invalid="ignore"):  # a signalling NaN
        ranges = np.asarray(msg.ranges).astype(np.float64)
    _check_limits("range_min", msg.range_min, "range_max", msg.range_max)
    first, step = msg.angle_min, msg.angle_increment
    span = abs(step) * len(ranges)
    if not (abs(first) <= _LARGEST_RAD and span <= _LARGEST_RAD):
        raise InvalidInputError(
            "out_of_range",
            f"angle_min {first}, angle_increment {step}, {len(ranges)} beams; expected "
            f"angles within ±{_LARGEST_RAD:g} rad",
        )
    angles = first + step * np.arange(len(ranges))
    directions = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    hit = (ranges > msg.range_min) & (ranges < msg.range_max)
    miss = np.isposinf(ranges) if inf_is_valid else np.zeros(len(ranges), np.bool_)
    return Observation(
        _HERE,
        directions[hit] * ranges[hit, None],
        directions[miss] * msg.range_max,
    )


def of_cloud(msg: PointCloud2) -> Observation:
    """Return the observation of a cloud, whose origin is the sensor.

    Points that are not finite are left out: no echo, but the cloud does not state the
    direction of the ray.

    Raises:
        InvalidInputError: no float x, y and z, or data of another size.
    """
    return Observation(_HERE, cloud_points(msg), _NOTHING)


def cloud_points(msg: PointCloud2) -> Points:
    """Return the finite points (N, 3) of a cloud, m.

    Raises:
        InvalidInputError: no float x, y and z, or data of another size.
    """
    fields = {f.name: f for f in msg.fields if f.datatype in _FORMATS}
    count, step, size = msg.width * msg.height, msg.point_step, len(msg.data)
    if count == 0 and size == 0:
        return _NOTHING
    if (
        not {"x", "y", "z"} <= set(fields)
        or count > _MOST_POINTS
        or step < 12
        or size != count * step
        or msg.row_step not in (0, step * msg.width)
    ):
        raise InvalidInputError(
            "invalid_cloud",
            f"{msg.width} x {msg.height} points of {step} bytes with fields "
            f"{sorted(f.name for f in msg.fields)[:8]} in {size} bytes; expected float "
            f"x, y and z, and width x height x point_step bytes (at most "
            f"{_MOST_POINTS} points)",
        )
    order = ">" if msg.is_bigendian else "<"
    data = np.asarray(msg.data, np.uint8).reshape(count, step)
    points = np.empty((count, 3))
    for column, name in enumerate("xyz"):
        field = fields[name]
        kind = np.dtype(order + _FORMATS[field.datatype])
        end = field.offset + kind.itemsize
        if end > step:
            raise InvalidInputError(
                "invalid_cloud",
                f"field {name} at {field.offset} in points of {step} bytes",
            )
        part = np.ascontiguousarray(data[:, field.offset : end])
        with np.errstate(invalid="ignore"):  # a signalling NaN
            points[:, column] = part.view(kind)[:, 0]
    x, y, z = np.abs(points).T
    near = (x <= _FARTHEST_M) & (y <= _FARTHEST_M) & (z <= _FARTHEST_M)
    return points if near.all() else points[near]


def of_range(msg: Range) -> Cone | None:
    """Return the cone of a reading; None if it contains no information.

    +inf and a reading of at least max_range mean that nothing was found (REP 117, and
    drivers before it); −inf is an object closer than min_range, taken to be there.

    Raises:
        InvalidInputError: its limits are not usable.
    """
    _check_limits("min_range", msg.min_range, "max_range", msg.max_range)
    if not 0.0 < msg.field_of_view <= math.pi:
        raise InvalidInputError(
            "out_of_range", f"field_of_view {msg.field_of_view}; expected 0 to pi"
        )
    half = msg.field_of_view / 2
    if math.isnan(msg.range):
        return None
    if msg.range >= msg.max_range:
        return Cone(msg.max_range, half, is_free=True)
    return Cone(max(msg.range, msg.min_range), half, is_free=False)


def _check_limits(low_name: str, low: float, high_name: str, high: float) -> None:
    """Check the limits of a sensor's range.

    Raises:
        InvalidInputError: they are not usable.
    """
    if not 0.0 <= low < high <= _FARTHEST_M:
        raise InvalidInputError(
            "out_of_range",
            f"{low_name} {low}, {high_name} {high}; expected 0 <= min < max <= "
            f"{_FARTHEST_M:g} m",
        )
