"""Checks of received messages, derived from their type, before a stage uses them.

The fields of a message have the types of its definition, but any value: NaN, 1e308, a
stamp of the year 1901, a grid whose size does not match its data. Names follow Nav2's
message validation.
"""

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple, NoReturn

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
Fault = Callable[[Any], InvalidInputError]
"""Returns what is wrong with a part of a message."""


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
        self._checks: dict[tuple[str, bool], SharedCheck] = {}

    def of(self, type_name: str, *, contents: bool = True) -> "SharedCheck":
        """As :func:`input_check`; skips the message that passed it last."""
        key = type_name, contents
        if key not in self._checks:
            check = input_check(type_name, contents=contents)
            self._checks[key] = SharedCheck(check)
        return self._checks[key]


class SharedCheck:
    """The check of one type of messages that the nodes of a context share.

    Attributes:
        passed: the message that passed last, and needs no call.
    """

    __slots__ = ("_check", "passed")

    def __init__(self, check: Check) -> None:
        self._check = check
        self.passed: Any = None

    def __call__(self, msg: Any) -> None:
        """Check a message, unless it passed last; raises InvalidInputError."""
        if msg is not self.passed:
            self._check(msg)
            self.passed = msg


def _check_of_fields(spec: MessageSpec, *, geometry: bool) -> Check | None:
    """Return the check of the fields that are messages, or None if all values pass.

    Its source is written out for the type: every message that arrives is checked, and a
    call for each field takes four times as long.
    """
    lines = list(_lines(_Place(spec, "msg", "", " "), geometry=geometry))
    if not lines:
        return None
    source = "\n".join(["def check_fields(msg):", *lines])
    scope: dict[str, Any] = {"refuse": _refuse}
    exec(compile(source, f"<check of {spec.name}>", "exec"), scope)
    check: Check = scope["check_fields"]
    return check


class _Place(NamedTuple):
    """A message within the one that is checked.

    Attributes:
        source: expression of the message.
        path: the prefix of its fields in errors, such as ``pose.``.
        pad: indentation of its checks.
    """

    spec: MessageSpec
    source: str
    path: str
    pad: str


def _lines(place: _Place, *, geometry: bool, headers: bool = True) -> Iterator[str]:
    """Yield the source lines that check the fields of a message."""
    spec, source, prefix, pad = place
    for field in spec.fields:
        base = field.type.base
        value, path = f"{source}._{field.name}", f"{prefix}{field.name}"
        if not field.type.is_message:
            continue
        if base not in _RULES:
            part = _Place(get_message_spec(base), value, f"{path}.", pad)
            if field.type.is_scalar:
                yield from _lines(part, geometry=geometry, headers=headers)
            else:
                yield from _loop(part, geometry=geometry)
        elif headers if base == _HEADER else geometry:
            is_scalar = field.type.is_scalar
            yield f"{pad}p = {value}" if is_scalar else f"{pad}for p in {value}:"
            test = f"if not ({_RULES[base].usable}): refuse({path!r}, {base!r}, p)"
            yield f"{pad}{test}" if is_scalar else f"{pad} {test}"


def _loop(elements: _Place, *, geometry: bool) -> Iterator[str]:
    """Yield the source lines that check the elements of a list.

    Their stamps, such as those of the poses of a path, are not used.
    """
    pad = elements.pad
    each = f"e{len(pad)}"
    element = elements._replace(source=each, pad=f"{pad} ")
    lines = list(_lines(element, geometry=geometry, headers=False))
    if lines:
        yield f"{pad}for {each} in {elements.source}:"
        yield from lines


def _refuse(path: str, base: str, part: Any) -> NoReturn:
    error = _RULES[base].fault(part)
    raise InvalidInputError(error.reason, f"{path}.{error.detail}")


def _stamp_fault(header: Any) -> InvalidInputError:
    stamp = header.stamp
    return InvalidInputError(
        "invalid_stamp",
        f"stamp is {stamp.sec} s and {stamp.nanosec} ns; "
        "sec must be >= 0 and nanosec below 1e9",
    )


def _vector_fault(vector: Any) -> InvalidInputError:
    return _unusable("x, y, z", (vector.x, vector.y, vector.z))


def _planar_fault(pose: Any) -> InvalidInputError:
    return _unusable("x, y, theta", (pose.x, pose.y, pose.theta))


def _quaternion_fault(q: Any) -> InvalidInputError:
    x, y, z, w = q.x, q.y, q.z, q.w
    if _any_not_finite((x, y, z, w)):
        return _unusable("x, y, z, w", (x, y, z, w))
    return InvalidInputError(
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
    if first - first != 0.0 or step - step != 0.0:
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


class _Rule(NamedTuple):
    """Condition of a usable part ``p`` of a message, and what is wrong with another."""

    usable: str
    fault: Fault


def _within(*names: str) -> str:
    tests = [f"-{FARTHEST!r} <= p._{name} <= {FARTHEST!r}" for name in names]
    return " and ".join(tests)


_HEADER = "std_msgs/msg/Header"
_VECTOR = _Rule(_within("x", "y", "z"), _vector_fault)
_NORM_SQUARED = "p._x * p._x + p._y * p._y + p._z * p._z + p._w * p._w"
_RULES: dict[str, _Rule] = {
    _HEADER: _Rule(
        f"0 <= p._stamp._sec and p._stamp._nanosec < {_NS_PER_S}", _stamp_fault
    ),
    "geometry_msgs/msg/Point": _VECTOR,
    "geometry_msgs/msg/Point32": _VECTOR,
    "geometry_msgs/msg/Vector3": _VECTOR,
    "geometry_msgs/msg/Pose2D": _Rule(_within("x", "y", "theta"), _planar_fault),
    "geometry_msgs/msg/Quaternion": _Rule(
        f"{_NORMS_SQUARED[0]!r} <= {_NORM_SQUARED} <= {_NORMS_SQUARED[1]!r}",
        _quaternion_fault,
    ),
}
_BY_TYPE: dict[str, Check] = {
    "sensor_msgs/msg/LaserScan": _check_scan,
    "nav_msgs/msg/OccupancyGrid": _check_grid,
}
