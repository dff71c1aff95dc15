"""Checks of received messages, derived from their type, before a stage uses them.

The fields of a message have the types of its definition, but any value: NaN, 1e308, a
stamp of the year 1901, a grid whose size does not match its data. Names follow Nav2's
message validation.
"""

from collections.abc import Callable, Iterator
from functools import cache
from operator import attrgetter
from typing import Any

from navette.errors import InvalidInputError
from navette.msgs.interface import MessageSpec
from navette.msgs.registry import get_message_spec

#: Largest magnitude of a coordinate (m) or velocity (m/s, rad/s).
FARTHEST = 1e9
#: Largest number of beams of a scan, and of cells of a grid.
MOST_BEAMS = 100_000
MOST_CELLS = 20_000**2

_NS_PER_S = 1_000_000_000
# An orientation from float32 or rounded text is still a unit quaternion.
_NORMS_SQUARED = (0.9**2, 1.1**2)

Check = Callable[[Any], None]


@cache
def input_check(type_name: str, *, contents: bool = True) -> Check:
    """Return a function that raises InvalidInputError for an unusable message.

    Args:
        type_name: such as ``nav_msgs/msg/Odometry``.
        contents: check points, vectors, orientations and sizes, too; otherwise only
            stamps.
    """
    checks = [_check_of_fields(get_message_spec(type_name), geometry=contents)]
    if contents and type_name in _BY_TYPE:
        checks.append(_BY_TYPE[type_name])
    used = [check for check in checks if check is not None]
    if len(used) == 1:
        return used[0]

    def check(msg: Any) -> None:
        for each in used:
            each(msg)

    return check


class SharedInputChecks:
    """The checks of the messages that the nodes of a context share: each one once.

    A shared message arrives at its receivers one after another, and none of them may
    change it: what has passed the check for one of them passes it for the others.
    """

    def __init__(self) -> None:
        self._checks: dict[tuple[str, bool], Check] = {}

    def of(self, type_name: str, *, contents: bool = True) -> Check:
        """As :func:`input_check`; skips the message that passed it last."""
        key = type_name, contents
        if key not in self._checks:
            self._checks[key] = _once(input_check(type_name, contents=contents))
        return self._checks[key]


def _once(check: Check) -> Check:
    passed: Any = None

    def check_once(msg: Any) -> None:
        nonlocal passed
        if msg is not passed:
            check(msg)
            passed = msg

    return check_once


def _check_of_fields(
    spec: MessageSpec, *, geometry: bool, headers: bool = True
) -> Check | None:
    """Return the check of the fields that are messages, or None if all values pass."""
    checked = [
        (path, attrgetter(path), check, is_scalar)
        for path, check, is_scalar in _checked_parts(
            spec, geometry=geometry, headers=headers
        )
    ]
    if not checked:
        return None

    def check_fields(msg: Any) -> None:
        for path, value_in, check, is_scalar in checked:
            try:
                if is_scalar:
                    check(value_in(msg))
                else:
                    for each in value_in(msg):
                        check(each)
            except InvalidInputError as error:
                raise InvalidInputError(
                    error.reason, f"{path}.{error.detail}"
                ) from None

    return check_fields


def _checked_parts(
    spec: MessageSpec, *, geometry: bool, headers: bool
) -> Iterator[tuple[str, Check, bool]]:
    """Yield path, check and whether it is a single value of each part to check.

    Parts of single messages come with their path, such as ``pose.pose.position``: a
    check that calls that of each level takes twice as long.
    """
    for field in spec.fields:
        name, type_ = field.name, field.type
        if not type_.is_message:
            continue
        if type_.base == "std_msgs/msg/Header":
            if headers:
                yield name, _check_header, type_.is_scalar
        elif type_.base in _GEOMETRY:
            if geometry:
                yield name, _GEOMETRY[type_.base], type_.is_scalar
        elif type_.is_scalar:
            inner = get_message_spec(type_.base)
            parts = _checked_parts(inner, geometry=geometry, headers=headers)
            for path, check, is_scalar in parts:
                yield f"{name}.{path}", check, is_scalar
        else:
            # The stamps of elements, such as the poses of a path, are not used.
            inner = get_message_spec(type_.base)
            each = _check_of_fields(inner, geometry=geometry, headers=False)
            if each is not None:
                yield name, each, False


def _check_header(header: Any) -> None:
    stamp = header.stamp
    if stamp.sec < 0 or stamp.nanosec >= _NS_PER_S:
        raise InvalidInputError(
            "invalid_stamp",
            f"stamp is {stamp.sec} s and {stamp.nanosec} ns; "
            "sec must be >= 0 and nanosec below 1e9",
        )


def _check_vector(vector: Any) -> None:
    x, y, z = vector.x, vector.y, vector.z
    if not (
        -FARTHEST <= x <= FARTHEST
        and -FARTHEST <= y <= FARTHEST
        and -FARTHEST <= z <= FARTHEST
    ):
        raise _unusable("x, y, z", (x, y, z))


def _check_planar(pose: Any) -> None:
    values = (pose.x, pose.y, pose.theta)
    if not all(-FARTHEST <= value <= FARTHEST for value in values):
        raise _unusable("x, y, theta", values)


def _check_quaternion(q: Any) -> None:
    x, y, z, w = q.x, q.y, q.z, q.w
    least, most = _NORMS_SQUARED
    if least <= x * x + y * y + z * z + w * w <= most:
        return
    if _any_not_finite((x, y, z, w)):
        raise _unusable("x, y, z, w", (x, y, z, w))
    raise InvalidInputError(
        "invalid_orientation",
        f"x, y, z, w = ({x:g}, {y:g}, {z:g}, {w:g}) is not a unit quaternion; for a "
        "heading θ use z = sin(θ/2), w = cos(θ/2)",
    )


def _unusable(names: str, values: tuple[float, ...]) -> InvalidInputError:
    shown = ", ".join(f"{value:g}" for value in values)
    if _any_not_finite(values):
        return InvalidInputError(
            "not_finite", f"{names} = ({shown}); must be finite numbers"
        )
    return InvalidInputError(
        "out_of_range", f"{names} = ({shown}); must be within ±{FARTHEST:g}"
    )


def _any_not_finite(values: tuple[float, ...]) -> bool:
    return any(value - value != 0.0 for value in values)


def _check_scan(scan: Any) -> None:
    first, step, count = scan.angle_min, scan.angle_increment, len(scan.ranges)
    if _any_not_finite((first, step)):
        raise InvalidInputError(
            "not_finite",
            f"angle_min = {first:g}, angle_increment = {step:g}; must be finite",
        )
    if not 1 <= count <= MOST_BEAMS:
        raise InvalidInputError(
            "wrong_length", f"{count} ranges; must be 1 to {MOST_BEAMS}"
        )
    if step == 0.0 and count > 1:
        raise InvalidInputError(
            "out_of_range", f"angle_increment = 0 with {count} ranges; must not be 0"
        )
    if not (abs(first) <= FARTHEST and abs(step) <= FARTHEST):
        raise _unusable("angle_min, angle_increment", (first, step))
    least, most = scan.range_min, scan.range_max
    if not 0.0 <= least < most:
        raise InvalidInputError(
            "out_of_range",
            f"range_min = {least:g}, range_max = {most:g}; must be 0 <= range_min < "
            "range_max",
        )


def _check_grid(grid: Any) -> None:
    info, count = grid.info, len(grid.data)
    width, height = info.width, info.height
    if not 1e-3 <= info.resolution <= 100.0:
        raise InvalidInputError(
            "out_of_range",
            f"info.resolution = {info.resolution:g}; must be 0.001 to 100 m",
        )
    if count != width * height or not 1 <= count <= MOST_CELLS:
        raise InvalidInputError(
            "wrong_length",
            f"{count} cells in data, {width} x {height} in info; must be equal, 1 to "
            f"{MOST_CELLS}",
        )


_GEOMETRY: dict[str, Check] = {
    "geometry_msgs/msg/Point": _check_vector,
    "geometry_msgs/msg/Point32": _check_vector,
    "geometry_msgs/msg/Vector3": _check_vector,
    "geometry_msgs/msg/Pose2D": _check_planar,
    "geometry_msgs/msg/Quaternion": _check_quaternion,
}
_BY_TYPE: dict[str, Check] = {
    "sensor_msgs/msg/LaserScan": _check_scan,
    "nav_msgs/msg/OccupancyGrid": _check_grid,
}
